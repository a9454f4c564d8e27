"""Three ranks of MPI, one of which hands out chunks: by ``MPIPoolExecutor``."""

import shutil
import subprocess
import sys
from importlib.util import find_spec

from common import Processes, same, skipped, sweep

if __name__ == "__main__" and sys.argv[1:2] == ["--store"]:
    from mpi4py.futures import MPIPoolExecutor

    with MPIPoolExecutor() as executor:
        sweep(sys.argv[2], executor)
elif __name__ == "__main__":
    if find_spec("mpi4py") is None or shutil.which("mpiexec") is None:
        skipped("mpi4py or mpiexec is not installed")
    with Processes() as processes:
        expected = sweep(processes.place / "here")
        store = processes.place / "mpi"
        root = ["--allow-run-as-root"] if "Open" in subprocess.getoutput("mpiexec --version") else []
        over = ["--oversubscribe"] if root else []
        script = [sys.executable, "-m", "mpi4py.futures", __file__, "--store", str(store)]
        subprocess.run(["mpiexec", *root, *over, "-n", "3", *script], check=True)
        import navwalker as nw

        same(nw.Sweep(store), expected)
