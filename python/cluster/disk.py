"""Full disks: of a worker, which needs none, and of the store, which says what is missing and is continued."""

import os
import subprocess

import navwalker as nw
from common import Processes, free_port, same, skipped, sweep
from distributed import Client

if os.geteuid() != 0:
    skipped("only root can mount small file systems")
with Processes() as processes:
    small = processes.place / "small"
    small.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "none", small])
    if mounted.returncode != 0:
        skipped("a small file system cannot be mounted here")
    try:
        expected = sweep(processes.place / "here")
        filler = small / "filler"
        with open(filler, "wb") as file:
            try:
                while file.write(bytes(4096)):
                    file.flush()
            except OSError:
                pass
        address = f"tcp://127.0.0.1:{free_port()}"
        processes.scheduler(address)
        processes.worker(address, local_directory=small)
        processes.worker(address)
        with Client(address, timeout=60) as client:
            client.wait_for_workers(2, timeout=60)
            same(sweep(processes.place / "dask", client), expected)
        filler.unlink()
        try:
            sweep(small / "store")
        except nw.NavwalkerError as error:
            print(f"the store is full: {error}")
            assert "No space left on device" in str(error)
        else:
            raise AssertionError("the store was not full")
        subprocess.run(["mount", "-o", "remount,size=64m", small], check=True)
        same(sweep(small / "store"), expected)
    finally:
        subprocess.run(["umount", "--lazy", small], check=True)
