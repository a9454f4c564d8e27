#!/usr/bin/env bash
# Sweeps on what takes the place of a cluster on one machine: MPI ranks, a scheduler that is restarted, a worker without the
# package, and three hosts as network namespaces of which one is cut off. What the machine does not allow is skipped with the reason.
#
#     bash python/cluster.sh PYTHON [NAME…]
#
# PYTHON is an interpreter with navwalker and distributed, and mpi4py for MPI; NAMEs are files of python/cluster without their ending.
set -euo pipefail
cd "$(dirname "$0")/cluster"
python="$(realpath -s "${1:?an interpreter with navwalker and distributed}")"
shift
[ $# -gt 0 ] || set -- restart package mpi network
failed=0
for name in "$@"; do
    began=$SECONDS
    if "$python" "$name.py"; then
        echo "$name: passed in $((SECONDS - began)) s"
    elif [ $? -eq 77 ]; then
        echo "$name: skipped"
    else
        echo "$name: FAILED"
        failed=1
    fi
done
exit $failed
