"""A study gives the same bits whatever the number of threads of its loops over elements, couples and rows of fields. BLAS has one
thread here, as the launcher starts it: the sums of a BLAS with several threads are its own affair."""

import unittest

import h5py
import numpy as np
from study_test import SOURCE, StudyTest

from meshes import brick, union, write_med

STUDY = SOURCE / "tests/bench/two_blocks.comm"
FIELDS = """
POURSUITE()
RESULT = CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, CONTRAINTE="SIGM_ELNO", CRITERES=("SIEQ_ELGA", "SIEQ_NOEU"), DEFORMATION="EPSI_ELGA",
                    FORCE=("FORC_NODA", "REAC_NODA"))
FIN()
"""


def two_blocks():
    """A curved block over a flat one, meshes that do not match: several batches of elements, several blocks of skin cells."""
    def above(x, y, z):
        return x, y, z + (1.0 - z) / 0.5 * 0.002 * (x * x + y * y)

    def lines(n, m, z0):
        return [np.linspace(0.0, 1.0, n + 1)] * 2 + [np.linspace(z0, z0 + 0.5, m + 1)]

    return union([brick("HEXA8", lines(9, 4, 0.0), name="VBOT", sides={(0, 0): "XB", (1, 0): "YB", (2, 0): "BASE", (2, 1): "CBOT"}),
                  brick("HEXA8", lines(8, 3, 0.5), place=above, name="VTOP",
                        sides={(0, 0): "XT", (1, 0): "YT", (2, 0): "CTOP", (2, 1): "TOP"})])


def datasets(base):
    """Everything that a base holds: (file, dataset) -> bytes."""
    found = {}
    for path in sorted(base.rglob("*.h5")):
        with h5py.File(path) as file:
            def take(name, item, path=path):
                if isinstance(item, h5py.Dataset):
                    value = item[()]
                    found[str(path.relative_to(base)), name] = value.tobytes() if item.dtype.kind in "fiu" else repr(value)
            file.visititems(take)
    return found


class Threads(StudyTest):
    def test_the_bits_do_not_depend_on_their_number(self):
        write_med(self.folder / "blocks.med", two_blocks())
        (self.folder / "fields.comm").write_text(FIELDS, encoding="utf-8")
        results = {}
        for threads in (1, 2, 3):
            base = self.folder / f"{threads}.base"
            run = self.run_lacon(STUDY, "fields.comm", "--base", base, "--unit", "20=blocks.med", "--threads", threads,
                                 BLOCKS_FLAT="0", BLOCKS_DZ="0.0011", OPENBLAS_NUM_THREADS="1")
            self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
            results[threads] = datasets(base)
        for field in ("DEPL", "SIEF_ELGA", "EPSI_ELGA", "SIEQ_NOEU", "FORC_NODA"):
            self.assertTrue(any(name.endswith(f"{field}_1.h5") for name, _ in results[1]), list(results[1]))
        self.assertGreater(len(results[1]), 50)
        for threads in (2, 3):
            self.assertEqual(results[threads].keys(), results[1].keys())
            self.assertEqual([key for key, value in results[threads].items() if value != results[1][key]], [])

    def test_a_number_of_threads_that_is_none_is_refused(self):
        (self.folder / "blocks.med").write_bytes(b"")
        run = self.run_lacon(STUDY, "--threads", "0", "--unit", "20=blocks.med", BLOCKS_FLAT="0", BLOCKS_DZ="0")
        self.assertEqual(run.status, 2)
        self.assertIn("--threads: give a number of at least 1", run.stderr)


if __name__ == "__main__":
    unittest.main()
