"""A worker whose Python has no navwalker: the sweep says so."""

import subprocess
import sys

import navwalker as nw
from common import ENVIRONMENT, Processes, free_port, sweep
from distributed import Client

# A finder that does not find the package, as if it were not installed.
WITHOUT = """
import sys
class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] == "navwalker":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Hidden())
from distributed.cli.dask_worker import main
main()
"""

with Processes() as processes:
    address = f"tcp://127.0.0.1:{free_port()}"
    processes.scheduler(address)
    command = [sys.executable, "-c", WITHOUT, address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    log = open(processes.place / "worker.log", "w")
    worker = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, env=ENVIRONMENT, start_new_session=True)
    processes.all.append(worker)
    with Client(address, timeout=60) as client:
        client.wait_for_workers(1, timeout=60)
        try:
            sweep(processes.place / "dask", client)
        except nw.SweepError as error:
            print(error)
            assert "a worker has no navwalker" in str(error)
        else:
            raise AssertionError("a worker without navwalker evaluated")
