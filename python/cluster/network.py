"""Three hosts as network namespaces, two of them with a worker; one is cut off in mid-sweep, with the chunk that it evaluates."""

import os
import shutil
import subprocess
import sys

from common import Processes, same, skipped, sweep, when_begun

HOSTS = ("nw-a", "nw-b", "nw-c")
BRIDGE = "nw-bridge"


def ip(*arguments, check=True):
    return subprocess.run(["ip", *arguments], check=check, capture_output=not check)


def remove():
    for host in HOSTS:
        ip("netns", "del", host, check=False)
    ip("link", "del", BRIDGE, check=False)


def make():
    ip("link", "add", BRIDGE, "type", "bridge")
    ip("link", "set", BRIDGE, "up")
    for number, host in enumerate(HOSTS, 1):
        ip("netns", "add", host)
        ip("link", "add", f"{host}-out", "type", "veth", "peer", "name", f"{host}-in", "netns", host)
        ip("link", "set", f"{host}-out", "master", BRIDGE, "up")
        ip("netns", "exec", host, "ip", "addr", "add", f"10.77.0.{number}/24", "dev", f"{host}-in")
        ip("netns", "exec", host, "ip", "link", "set", f"{host}-in", "up")
        ip("netns", "exec", host, "ip", "link", "set", "lo", "up")


def main():
    if os.geteuid() != 0 or shutil.which("ip") is None:
        skipped("network namespaces need root and iproute2")
    remove()
    if ip("netns", "add", HOSTS[0], check=False).returncode != 0:
        skipped("network namespaces are not allowed here")
    remove()
    on = lambda host: ["ip", "netns", "exec", host]
    try:
        make()
        with Processes() as processes:
            expected = sweep(processes.place / "here")
            address = "tcp://10.77.0.1:8786"
            processes.scheduler(address, on("nw-a"))
            processes.worker(address, on("nw-b"))
            processes.worker(address, on("nw-c"))
            store = processes.place / "dask"

            def cut():
                ip("link", "set", "nw-c-out", "down")
                print("the third host is cut off", flush=True)

            thread = when_begun(store, cut)
            client = processes.start(["client", address, str(store)], on("nw-a"))
            status = client.wait(timeout=300)
            thread.join()
            if status != 0:
                print((processes.place / "3.log").read_text())
                sys.exit(1)
            import navwalker as nw

            same(nw.Sweep(store), expected)
    finally:
        remove()


if __name__ == "__main__":
    main()
