"""A client of Dask on a host of its own: ``python client.py SCHEDULER STORE``."""

import sys

from common import sweep
from distributed import Client

with Client(sys.argv[1], timeout=60) as client:
    client.wait_for_workers(2, timeout=60)
    sweep(sys.argv[2], client)
