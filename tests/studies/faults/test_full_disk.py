"""A disk that fills up or fails at any moment of a study: a clear error, nothing half-written, and the same command file again comes to the same end."""

import os
import pathlib
import re
import struct
import sys

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from test_threads import datasets  # noqa: E402, I001

from .small_study import SmallStudy  # noqa: E402

SHIM = pathlib.Path(os.environ["LACON_BINARY_DIR"]).resolve() / "tests/full_disk.so"
PLENTY = 1 << 40


def naming(files, base=""):
    """How files of a study are called whatever was begun twice: by the place of their concept among those there are, not its number, and
    SIGM_NOEU_0_2.h5 as SIGM_NOEU_0.h5. @param base what names of concepts stand behind"""
    concept = re.compile(rf"{re.escape(base)}(kept/)?([a-z_]+)_(\d+)(?=[./]|$)")
    numbers = sorted({int(found[3]) for found in map(concept.match, files) if found})

    def name(file):
        if found := concept.match(file):
            file = f"{base}{found[1] or ''}{found[2]}_{numbers.index(int(found[3]))}{file[found.end():]}"
        return re.sub(r"(_\d+)_\d+(?=(\.masters)?\.h5$)", r"\1", file)

    return name


def fields(base):
    """What a base holds, without names of files and concepts, which the index of a result, its copy in kept/ and a material field know."""
    found = datasets(base)
    called = naming({file for file, _ in found})
    return {(called(file), name): value for (file, name), value in found.items()
            if not (file.endswith("index.h5") or file.startswith("kept/") or name == "materials")}


class FullDisk(SmallStudy):
    def run_on_disk(self, name, left, fails=0, halves=False):
        """Run the study on a disk that takes `left` bytes more. @param fails the write that gives an error, from 1 @param halves whether
        writes take half of their bytes @return the run"""
        (self.folder / "disk").write_bytes(struct.pack("<4q", left, 0, fails, halves))
        return self.run_small(name, LD_PRELOAD=str(SHIM), LACON_TEST_DISK=str(self.folder / "disk"))

    def used(self):
        """(bytes, writes) of the last run."""
        left, writes, *_ = struct.unpack("<4q", (self.folder / "disk").read_bytes())
        return PLENTY - left, writes

    def files(self, name):
        found = {str(path.relative_to(self.folder)) for path in self.folder.rglob("*") if path.relative_to(self.folder).parts[0].startswith(name)}
        return set(map(naming(found, f"{name}.base/"), found))

    def ends_as(self, expected, name):
        """The same command again, on a sound disk."""
        again = self.run_small(name)
        self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
        found = fields(self.folder / f"{name}.base")
        self.assertEqual([key for key in found.keys() | expected.keys() if found.get(key) != expected.get(key)], [])

    def fail_a_write(self, shares):
        """The study on disks that fail one write, and again."""
        whole = self.run_on_disk("whole", PLENTY)
        self.assertEqual(whole.returncode, 0, whole.stderr)
        _, writes = self.used()
        expected = fields(self.folder / "whole.base")
        for number, share in enumerate(shares):
            name, fails = f"part{number}_", 1 + int(share * (writes - 1))
            with self.subTest(share=share, write=fails):
                run = self.run_on_disk(name, PLENTY, fails=fails)
                self.assertNotIn("Traceback", run.stderr)
                if run.returncode == 0:  # a line of the journal, which is for who looks on
                    self.assertEqual(fields(self.folder / f"{name}.base"), expected)
                    continue
                self.assertEqual((run.returncode, run.stdout.splitlines()[-1]), (2, "--- DIAGNOSTIC JOB : <F>_ERROR"), run.stdout + run.stderr)
                self.assertRegex(run.stderr, "BASE_3.* cannot be written|Input/output error")
                self.ends_as(expected, name)

    def fill(self, levels):
        """The study on disks that are full after a share of what it writes, and again with room enough."""
        whole = self.run_on_disk("whole", PLENTY)
        self.assertEqual(whole.returncode, 0, whole.stderr)
        needed, _ = self.used()
        expected = fields(self.folder / "whole.base")
        self.assertGreater(len(expected), 50)
        for number, share in enumerate(levels):
            name = f"part{number}_"
            with self.subTest(share=share, bytes=int(share * needed)):
                run = self.run_on_disk(name, int(share * needed))
                self.assertEqual((run.returncode, run.stdout.splitlines()[-1]), (2, "--- DIAGNOSTIC JOB : <F>_ERROR"), run.stdout + run.stderr)
                self.assertIn("No space left on device", run.stderr)
                self.assertNotIn("Traceback", run.stderr)
                self.assertEqual([file for file in self.files(name) if ".partial" in file and ".base/" not in file], [])
                for path in self.folder.glob(f"{name}*.rmed"):
                    h5py.File(path).close()  # whole, or not there
                self.ends_as(expected, name)
                self.assertEqual({file.replace(name, "whole") for file in self.files(name)}, self.files("whole"))


class Short(FullDisk):
    def test_the_same_command_again_comes_to_the_same_end(self):
        self.fill([0, 0.002, 0.05, 0.3, 0.48, 0.98])


    def test_a_write_that_fails_is_told(self):
        self.fail_a_write([0, 0.1, 0.5, 0.9])

    def test_writes_that_take_a_part_are_gone_on_with(self):
        whole, halved = self.run_small("whole"), self.run_on_disk("halved", PLENTY, halves=True)
        self.assertEqual((whole.returncode, halved.returncode), (0, 0), halved.stdout + halved.stderr)
        self.assertEqual(fields(self.folder / "halved.base"), fields(self.folder / "whole.base"))


class Long(FullDisk):
    def test_the_same_command_again_comes_to_the_same_end(self):
        self.fill([level / 64 for level in range(64)])

    def test_a_write_that_fails_is_told(self):
        self.fail_a_write([share / 64 for share in range(65)])
