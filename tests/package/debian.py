"""A Debian 12 of its own in a folder: what a machine is on which nobody has done anything yet. Needs root, debootstrap and a mirror."""

import os
import pathlib
import shutil
import subprocess
import tempfile

MIRROR = os.environ.get("LACON_DEBIAN_MIRROR", "http://deb.debian.org/debian")
#: nothing of the machine outside
ENVIRONMENT = {"PATH": "/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/lacon", "LANG": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive",
               "NODE_EXTRA_CA_CERTS": "/etc/outside.crt"}
#: whom the machine outside trusts: npm's registry may be behind a proxy of its own
TRUSTED = pathlib.Path("/etc/ssl/certs/ca-certificates.crt")


def possible():
    return os.geteuid() == 0 and shutil.which("debootstrap") is not None


def run(*command, **options):
    """Run a command to its end. @return what it printed; AssertionError with the end of that where it fails"""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, **options)
    if done.returncode:
        raise AssertionError(f"{command} failed:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


class Debian:
    """The smallest Debian 12 in a new folder under /tmp, with the network of the machine outside; leaving the context removes it."""

    def __enter__(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="lacon_debian_"))
        try:
            run("debootstrap", "--variant=minbase", "bookworm", self.root, MIRROR)
            for path in ("/etc/resolv.conf", "/etc/hosts"):
                shutil.copyfile(path, self.root / path[1:])
            if TRUSTED.exists():
                shutil.copyfile(TRUSTED, self.root / ENVIRONMENT["NODE_EXTRA_CA_CERTS"][1:])
            run("mount", "-t", "proc", "proc", self.root / "proc")
            run("mount", "-t", "devpts", "-o", "newinstance,ptmxmode=0666", "devpts", self.root / "dev/pts")  # terminals, which tests open
            (self.root / "dev/ptmx").unlink(missing_ok=True)
            (self.root / "dev/ptmx").symlink_to("pts/ptmx")
            (self.root / "etc/dpkg/dpkg.cfg.d/unsafe-io").write_text("force-unsafe-io\n", encoding="ascii")  # it need not survive a power failure
            self.home.mkdir()
            self.inside("apt-get", "-q", "update")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for mounted, present in (("dev/pts", "dev/pts/ptmx"), ("proc", "proc/self")):
            if (self.root / present).exists():
                run("umount", self.root / mounted)
        if str(self.root) not in pathlib.Path("/proc/mounts").read_text(encoding="utf-8"):  # what is mounted is not ours to remove
            shutil.rmtree(self.root, ignore_errors=True)

    @property
    def home(self):
        return self.root / ENVIRONMENT["HOME"].lstrip("/")

    def command(self, *command):
        """The words that run a command inside."""
        return ["chroot", str(self.root), *map(str, command)]

    def inside(self, *command):
        return run(*self.command(*command), env=ENVIRONMENT)
