"""A scheduler that is killed in mid-sweep, and started again with new workers: the sweep ends with the same bytes."""

from common import Processes, free_port, same, sweep, when_begun
from distributed import Client

with Processes() as processes:
    expected = sweep(processes.place / "here")
    address = f"tcp://127.0.0.1:{free_port()}"
    scheduler = processes.scheduler(address)
    workers = [processes.worker(address) for _ in range(2)]
    with Client(address, timeout=60) as client:
        client.wait_for_workers(2, timeout=60)

        def restart():
            for one in (scheduler, *workers):
                processes.kill(one)
            print("the scheduler and its workers are killed")
            processes.scheduler(address)
            processes.worker(address)
            processes.worker(address)

        thread = when_begun(processes.place / "dask", restart)
        same(sweep(processes.place / "dask", client), expected)
        thread.join()
