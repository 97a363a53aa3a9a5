"""The processor that a run may use."""

import os
import pathlib

#: what a container may take, of microseconds in each period: "max 100000", "150000 100000"
_QUOTA = pathlib.Path("/sys/fs/cgroup/cpu.max")


def available_cores(quota=_QUOTA):
    """@return how many cores this process may keep busy: those that it may run on, or as many as its container's share of their time makes"""
    cores = len(os.sched_getaffinity(0))
    try:
        share, period = quota.read_text(encoding="ascii").split()
        return min(cores, max(1, round(int(share) / int(period))))
    except (OSError, ValueError):  # there is no share, or no limit of it
        return cores
