#!/usr/bin/python3
"""docs/clean-machine.md anew: what the README and the tutorial tell a new user to do, done on a Debian 12 with nothing on it, with the time of each step.

    tests/package/clean_machine.py docs/clean-machine.md [--tests REGEX] [--ccache FOLDER]

Needs root, debootstrap and a mirror of Debian. --tests keeps ./commands/check to the tests whose names match; --ccache takes objects from a cache of
ccache, where only the way is of interest, and not how long compiling takes. A step that fails ends it.
"""

import argparse
import contextlib
import datetime
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time

from debian import ENVIRONMENT, Debian, run

SOURCE = pathlib.Path(__file__).resolve().parents[2]
#: lines of a step's output that are shown: where it begins, where it ends
HEAD, TAIL = 3, 12


def processor_seconds():
    """What all processes that have ended took."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Transcript:
    """What was typed, what came back, and how long that took."""

    def __init__(self, page, about):
        self.page, self.about = page, about
        self.rows, self.text, self.more = [], [], {}

    def chapter(self, title):
        self.text.append(f"\n## {title}\n")

    def step(self, system, what, command, folder="~", tail=TAIL):
        """Run a shell command on a system, and write down what came."""
        print(f"{what}: {command}", flush=True)
        start, used = time.monotonic(), processor_seconds()
        done = subprocess.run(system.command("bash", "-c", f"cd {folder} && {command}"), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, errors="replace", check=False, env={**ENVIRONMENT, **self.more})
        seconds, used = time.monotonic() - start, processor_seconds() - used
        lines = [line.rstrip().rpartition("\r")[2] for line in done.stdout.splitlines()]
        if done.returncode:
            print("\n".join(lines[-60:]), flush=True)
            sys.exit(f"{command} failed: status {done.returncode}")
        print(f"  {seconds:.0f} s, of processor {used:.0f} s", flush=True)
        if len(lines) > HEAD + tail + 1:
            lines[HEAD:-tail] = [f"[... {len(lines) - HEAD - tail} lines ...]"]
        self.rows.append((what, command, seconds, used))
        prompt = [f"{folder}$ {command}", *(line[:170] for line in lines)]
        self.text.append("\n".join(f"    {line}".rstrip() for line in [*prompt, f"# {clock(seconds)}"]) + "\n")
        self.write()

    def write(self):
        """What there is so far."""
        table = "\n".join(f"| {what} | `{re.sub('^export [^;]*; ', '', command)}` | {clock(seconds)} | {clock(used)} |" for what, command, seconds, used in self.rows)
        self.page.write_text(f"{self.about}\n| step | command | time | of processor |\n|---|---|---|---|\n{table}\n{''.join(self.text)}", encoding="utf-8")


def clock(seconds):
    return f"{seconds:.1f} s" if seconds < 100 else f"{seconds / 60:.1f} min"


def tutorial_blocks():
    """The commands of the tutorial, as they stand in it, each block with the heading above."""
    text = (SOURCE / "docs/tutorial.md").read_text(encoding="utf-8")
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        for block in re.findall(r"^```sh\n(.*?)^```$", part, re.MULTILINE | re.DOTALL):
            yield part.partition("\n")[0], block.strip().splitlines()


def build_and_try(said, system):
    """From the clone to the package. @return its file"""
    said.chapter("From a clone to a study")
    said.step(system, "git", "apt-get install -q -y --no-install-recommends git ca-certificates", tail=2)
    run("git", "clone", "-q", "--bare", SOURCE, system.root / "srv/lacon.git")
    said.step(system, "clone", "git clone /srv/lacon.git lacon")
    said.step(system, "demo: packages, build, a study", "./commands/demo", "~/lacon", tail=45)
    said.chapter("The tutorial")
    folder = "~"
    for heading, lines in tutorial_blocks():
        for line in lines:
            if line.startswith("cd "):
                folder += "/" + line[3:]
            else:
                said.step(system, f"tutorial, {heading}", f"export PATH=$PATH:~/lacon/build/release/bin PYTHONPATH=~/lacon/commands; {line}", folder)
    said.chapter("The report")
    said.step(system, "report", "~/lacon/build/release/bin/lacon report hertz.base && ls -sh hertz.html", folder)
    said.chapter("The package")
    said.step(system, "package", "./commands/package", "~/lacon", tail=4)
    [package] = (system.home / "lacon/build/package").glob("lacon_*.deb")
    return package


def install(said, system, package):
    """The package on a system that has nothing else."""
    shutil.copy(package, system.home)
    said.chapter("The package on another machine")
    said.step(system, "install the package", "apt-get install -q -y --no-install-recommends ./lacon_*.deb", tail=4)
    said.step(system, "a study from the package", "lacon new --template hertz && cd hertz && lacon hertz.comm")
    said.step(system, "report from the package", "lacon report hertz.base && ls -sh hertz.html", "~/hertz")


def check(said, system, tests):
    """The second command of the README, which takes longest."""
    said.chapter("The tests")
    said.step(system, "check: build of the tests, tests", "./commands/check" + (f" --only '{tests}'" if tests else ""), "~/lacon")


def about(cached):
    """The head of the page."""
    version = run("git", "-C", SOURCE, "rev-parse", "--short", "HEAD").strip()
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return f"""# A clean machine

What the README and the [tutorial](tutorial.md) tell a new user to do, done on a Debian 12 with nothing on it (debootstrap's smallest, in a chroot), step by step; then the
package on a second one. `tests/package/clean_machine.py` made this page on {datetime.date.today():%d %B %Y}, of commit {version}, on {os.cpu_count()} processors
(load before the first step: {os.getloadavg()[1]:.1f}), with {memory:.0f} GB of memory and a fast network.{" Compiled objects came from a cache: the times of building are not those of a new machine." if cached else ""}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--tests", help="of ./commands/check, those whose names match")
    parser.add_argument("--ccache", type=pathlib.Path, help="a cache of ccache to take objects from")
    arguments = parser.parse_args()
    with contextlib.ExitStack() as stack:
        said = Transcript(arguments.page, about(arguments.ccache))
        start, used = time.monotonic(), processor_seconds()
        system = stack.enter_context(Debian())
        said.rows.append(("an empty Debian 12", "debootstrap --variant=minbase bookworm", time.monotonic() - start, processor_seconds() - used))
        if arguments.ccache:
            system.inside("apt-get", "-q", "-y", "install", "--no-install-recommends", "ccache")
            (system.root / "ccache").mkdir()
            run("mount", "--bind", arguments.ccache, system.root / "ccache")
            stack.callback(run, "umount", system.root / "ccache")
            said.more = {"CMAKE_CXX_COMPILER_LAUNCHER": "ccache", "CMAKE_C_COMPILER_LAUNCHER": "ccache", "CCACHE_DIR": "/ccache", "CCACHE_NOHASHDIR": "1",
                         "CCACHE_BASEDIR": f"{ENVIRONMENT['HOME']}/lacon", "CCACHE_SLOPPINESS": "time_macros"}
        package = build_and_try(said, system)
        with Debian() as other:
            install(said, other, package)
        check(said, system, arguments.tests)


if __name__ == "__main__":
    main()
