"""A contact that is smaller than the patches that carry it is told: a cylinder and a sphere on a block, against Hertz."""

import math
import os
import pathlib
import sys

import numpy as np

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from contact import contact_study, normal_force, run_contact  # noqa: E402
from meshes import block, brick, union  # noqa: E402
from test_alternation import belt  # noqa: E402

RADIUS, EXTENT, YOUNG, POISSON = 100.0, 6.0, 2000.0, 0.3
OFF = 0.37  #: of the round body's cells, beside those of symmetry


def pressed(kind, cells, slave, depth):
    """@param kind QUAD4, QUAD8 (a cylinder) or HEXA8 (a sphere) @param cells along (the round body, the block) @param slave ROUND or BLOCK"""
    in_space = kind == "HEXA8"
    along, across = (np.linspace(-EXTENT, EXTENT, n + 1) for n in cells)
    along = along + OFF

    def place(x, *rest):
        low = RADIUS - math.sqrt(RADIUS**2 - x**2 - sum(y**2 for y in rest[:-1]))
        return (x, *rest[:-1], low + rest[-1] * (EXTENT - low))

    through, deep = np.linspace(0, 1, 5), np.linspace(-EXTENT, 0, 6)
    if in_space:
        round_body = brick(kind, [along, along, through], place, "ROUND", {(2, 0): "ROUND_SKIN", (2, 1): "ROUND_BASE"})
        base = brick(kind, [across, across, deep], None, "BLOCK", {(2, 1): "BLOCK_SKIN", (2, 0): "BLOCK_BASE"})
    else:
        round_body = block(kind, along, through, place, "ROUND", {"bottom": "ROUND_SKIN", "top": "ROUND_BASE"})
        base = block(kind, across, deep, None, "BLOCK", {"top": "BLOCK_SKIN", "bottom": "BLOCK_BASE"})
    down, fixed = ("DZ", {"DX": 0.0, "DY": 0.0}) if in_space else ("DY", {"DX": 0.0})
    hold = [{"GROUP_MA": "ROUND_BASE", **fixed, down: -depth}, {"GROUP_MA": "BLOCK_BASE", **fixed, down: 0.0}]
    master = "BLOCK" if slave == "ROUND" else "ROUND"
    return contact_study(union([round_body, base]), hold, slaves=[f"{slave}_SKIN"], masters=[f"{master}_SKIN"], model="3D" if in_space else "D_PLAN",
                         elastic={"E": YOUNG, "NU": POISSON}, convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 40})


def share_of_peak(result, in_space):
    """The largest pressure of a patch over that of Hertz for the force that was found; nothing without a force."""
    pressure = result.on_cells("CONT_ELEM", result.orders[-1], "PRES")
    force = normal_force(result)
    if force <= 0:
        return None
    modulus = YOUNG / (2 * (1 - POISSON**2))
    if in_space:
        radius = (3 * force * RADIUS / (4 * modulus)) ** (1 / 3)
        return -min(pressure.values()) / (3 * force / (2 * math.pi * radius**2))
    return -min(pressure.values()) / (2 * force / (math.pi * math.sqrt(4 * force * RADIUS / (math.pi * modulus))))


class CoarseContact(StudyTest):
    def solved(self, study):
        """@return (the alarms, the result)"""
        run, (result,) = run_contact(self, [study], CONTACT_ALARMS="ALARME")
        return [line for line in (run.stdout + run.stderr).splitlines() if line.startswith("<A> ")], result

    def test_what_patches_cannot_show_is_told(self):
        """Below half of Hertz' pressure EVOLUTION_72 is said, above four fifths nothing is; with the same depths, so that it is the size of the
        contact that counts. Where all averages stay open EVOLUTION_16 says so."""
        seen = set()
        for kind, cells, slave, depth in (("QUAD4", (12, 8), "BLOCK", 0.01), ("QUAD4", (12, 18), "BLOCK", 0.01), ("QUAD4", (12, 8), "BLOCK", 0.003),
                                          ("QUAD8", (12, 8), "ROUND", 0.001), ("QUAD8", (12, 8), "ROUND", 0.01), ("QUAD8", (12, 8), "BLOCK", 0.03),
                                          ("HEXA8", (12, 8), "ROUND", 0.003), ("HEXA8", (12, 8), "BLOCK", 0.003), ("HEXA8", (12, 8), "BLOCK", 0.01),
                                          ("HEXA8", (12, 8), "BLOCK", 0.03), ("HEXA8", (12, 18), "ROUND", 0.03)):
            with self.subTest(kind=kind, cells=cells, slave=slave, depth=depth):
                alarms, result = self.solved(pressed(kind, cells, slave, depth))
                share = share_of_peak(result, kind == "HEXA8")
                expected = "EVOLUTION_16" if share is None else "EVOLUTION_72" if share < 0.5 else None
                self.assertTrue(share is None or share < 0.5 or share > 0.8, share)
                self.assertEqual([line.split("<")[2].split(">")[0] for line in alarms], [expected] if expected else [], alarms)
                seen.add(expected)
        self.assertEqual(seen, {None, "EVOLUTION_16", "EVOLUTION_72"})

    def test_bodies_that_fit_are_not_told(self):
        """Of a belt on its pulley points lie inside by what facets leave, under a pressure that presses in far less; all patches carry it."""
        alarms, _ = self.solved(belt("QUAD4", (30, 20)))
        self.assertEqual([line for line in alarms if "<EVOLUTION_72>" in line], [])

    def test_one_patch_under_a_flat_body_is_not_told(self):
        lower = block("QUAD4", np.linspace(-1, 1, 4), np.linspace(-1, 0, 4), None, "LOWER", {"top": "LOWER_SKIN", "bottom": "LOWER_BASE"})
        upper = block("QUAD4", np.linspace(-0.5, 0.5, 2), np.linspace(0, 1, 3), None, "UPPER", {"bottom": "UPPER_SKIN", "top": "UPPER_BASE"})
        hold = [{"GROUP_MA": "LOWER_BASE", "DX": 0.0, "DY": 0.0}, {"GROUP_MA": "UPPER_BASE", "DX": 0.0, "DY": -0.01}]
        alarms, result = self.solved(contact_study(union([lower, upper]), hold, slaves=["UPPER_SKIN"], masters=["LOWER_SKIN"], model="D_PLAN",
                                                   convergence={"RESI_GLOB_RELA": 1e-9}))
        self.assertEqual(alarms, [])
        self.assertLess(min(result.on_cells("CONT_ELEM", result.orders[-1], "PRES").values()), 0)

    def test_pressures_where_little_is_covered_are_told_apart(self):
        """The corner of a punch, of which three hundredths of a patch have come in: the multiplier is the force over these."""
        lower = block("QUAD4", np.linspace(-4, 4, 9), np.linspace(-4, 0, 5), None, "LOWER", {"top": "LOWER_SKIN", "bottom": "LOWER_BASE"})
        tilt = math.radians(10)
        upper = block("QUAD4", np.linspace(-2, 0, 9), np.linspace(0, 2, 9), lambda x, y: (0.03 + x * math.cos(tilt) + y * math.sin(tilt), y * math.cos(tilt) - x * math.sin(tilt)),
                      "UPPER", {"bottom": "UPPER_SKIN", "top": "UPPER_BASE"})
        hold = [{"GROUP_MA": "LOWER_BASE", "DX": 0.0, "DY": 0.0}, {"GROUP_MA": "UPPER_BASE", "DX": 0.0, "DY": -0.2}]
        study = contact_study(union([lower, upper]), hold, slaves=["LOWER_SKIN"], masters=["UPPER_SKIN"], model="D_PLAN", times=[0.0, 0.5, 1.0],
                              convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 40})
        run, (result,) = run_contact(self, [study], CONTACT_ALARMS="ALARME")
        pressure, over_whole, covered = (result.on_cells("CONT_ELEM", result.orders[-1], name) for name in ("PRES", "PRESCOOR", "COEFSURF"))
        pressed = [patch[0] for patch in result.patches if pressure[patch[0]] < 0]
        half = [pressure[cell] for cell in pressed if covered[cell] >= 0.5]
        self.assertTrue(half and min(pressure.values()) < 2 * min(half), pressure)
        self.assertIn(f"LAGS_C of the patches in contact from {min(pressure.values()):.9g} to {max(pressure[cell] for cell in pressed):.9g} "
                      f"(of patches that are covered by half or more: from {min(half):.9g}; PRESCOOR is over whole patches)", run.stdout)
        at_nodes = result.at_nodes("CONT_NOEU", result.orders[-1], "PRES")
        self.assertGreaterEqual(np.min(at_nodes), min(over_whole.values()) * (1 + 1e-12))
