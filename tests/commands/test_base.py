"""The base of a study: made, kept, emptied, cleaned, never half-written, and never somebody else's folder."""

import fcntl
import json
import os
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import ROOT, STUDY, LauncherTest  # noqa: E402
import lacon  # noqa: E402
from lacon.base import registry  # noqa: E402

MATERIAL = "DEFI_MATERIAU(ELAS=_F(E=1, NU=0))"


class Life(LauncherTest):
    def test_it_lies_beside_the_command_file(self):
        (self.work / "sub").mkdir()
        self.write("sub/study.comm", f"DEBUT()\nA = {MATERIAL}\nFIN()\n")
        self.ok(self.launch("sub/study.comm"))
        self.assertEqual(self.entries("sub/study.base"), ["material_1"])

    def test_base_option(self):
        self.ok(self.run_study(f"DEBUT()\nA = {MATERIAL}\nFIN()\n", "--base", "other"))
        self.assertEqual(self.entries("other"), ["material_1"])
        self.assertFalse((self.work / "study.base").exists())

    def test_debut_keeps_what_is_there_until_it_is_assigned_again(self):
        self.ok(self.run_study(f"DEBUT()\nA = {MATERIAL}\nB = {MATERIAL}\nx = 1\nFIN()\n"))
        self.ok(self.run_study(f"DEBUT()\nA = {MATERIAL.replace('E=1', 'E=2')}\nFIN()\n"))
        self.assertEqual(self.registry()["labels"], {"A": "material_3", "B": "material_2"})
        self.assertEqual(self.entries(), ["material_2", "material_3"])
        self.assertEqual(self.registry()["namespace"]["values"], {}, "plain data of the earlier run is not this run's")

    def test_debut_with_fresh_empties_it(self):
        self.ok(self.run_study(f"DEBUT()\nA = {MATERIAL}\nB = {MATERIAL}\nFIN()\n"))
        (self.work / "study.base" / "notes.txt").write_text("mine")
        self.ok(self.run_study(f"DEBUT()\nC = {MATERIAL}\nFIN()\n", "--fresh"))
        self.assertEqual(self.registry()["labels"], {"C": "material_1"})
        self.assertEqual(self.entries(), ["material_1", "notes.txt"], "what Lacon did not write stays")

    def test_poursuite_never_empties_it(self):
        self.ok(self.run_study(f"DEBUT()\nA = {MATERIAL}\nFIN()\n"))
        self.ok(self.run_study("POURSUITE()\nA.open()\nFIN()\n", "--fresh"))

    def test_a_folder_of_something_else_is_left_alone(self):
        folder = self.work / "study.base"
        folder.mkdir()
        (folder / "thesis.tex").write_text("years of work")
        for options in ((), ("--fresh",)):
            self.refused(self.run_study("DEBUT()\n", *options), "STUDY_4", "study.base", "study.comm:1")
        self.assertEqual(os.listdir(folder), ["thesis.tex"])

    def test_a_file_in_its_place(self):
        (self.work / "study.base").write_text("a file")
        self.refused(self.run_study("DEBUT()\n"), "STUDY_4")
        self.assertEqual((self.work / "study.base").read_text(), "a file")

    def test_an_unwritable_place(self):
        (self.work / "file").write_text("")
        self.refused(self.run_study("DEBUT()\n", "--base", "file/below/study.base"), "STUDY_3", "file/below")
        self.refused(self.run_study("DEBUT()\n", "--base", "missing/study.base"), "STUDY_3", "missing")
        self.assertFalse((self.work / "missing").exists())

    def test_a_broken_registry(self):
        (self.work / "study.base").mkdir()
        for text in ("{", "[]", '{"format": 99, "labels": {}, "next": 1}', '{"format": 1}'):
            (self.work / "study.base" / "base.json").write_text(text)
            self.refused(self.run_study("DEBUT()\n"), "STUDY_6")
            self.assertEqual((self.work / "study.base" / "base.json").read_text(), text)

    def change(self, old, new, seal=False):
        """Change what is written in the registry; with `seal` it gets the seal of what it then is."""
        path = self.work / "study.base/base.json"
        text = path.read_text()
        self.assertEqual(text.count(old), 1, text)
        content = json.loads(text.replace(old, new))
        path.write_text(registry.sealed({k: v for k, v in content.items() if k != "seal"}) if seal else text.replace(old, new))
        return text

    def test_a_byte_that_changes_in_the_registry_is_told(self):
        """Without a seal "mesh_4" that became "mesh_3" gave the study another mesh, without a word."""
        self.ok(self.run_study(STUDY + "N = [1.5, 'text']\nFIN()\n"))
        path = self.work / "study.base/base.json"
        text = path.read_bytes()
        for at, byte in enumerate(text):
            for other in {byte ^ 1, byte ^ 2, ord("0"), ord('"')} - {byte, 127}:
                path.write_bytes(text[:at] + bytes((other,)) + text[at + 1:])
                with self.assertRaises(registry.Unreadable, msg=f"{at}: {text[max(at - 20, 0):at + 20]} with {chr(other)}"):
                    registry.read(path.parent)
        for at in [text.index(b'"M": "mesh_4"') + 11, *range(0, len(text), len(text) // 7)]:
            path.write_bytes(text[:at] + (b"3" if text[at] != ord("3") else b"4") + text[at + 1:])
            changed = path.read_bytes()
            self.refused(self.run_study("POURSUITE()\nprint('M', M)\nFIN()\n"), "STUDY_6", "study.base/base.json'")
            self.assertEqual(path.read_bytes(), changed)
        with self.assertRaisesRegex(lacon.Error, "STUDY_6.*study.base/base.json'"):
            lacon.open(path.parent)
        path.write_bytes(text)
        self.ok(self.run_study("POURSUITE()\nFIN()\n"))

    def test_a_registry_that_has_changed_is_one_all_the_same(self):
        """It is ours, so --fresh empties its base, and takes nothing of it."""
        self.ok(self.run_study(STUDY + "FIN()\n"))
        self.change('"M": "mesh_4"', '"M": "mesh_3"')
        self.ok(self.run_study("DEBUT()\nFIN()\n", "--fresh"))
        self.assertEqual(self.registry()["labels"], {})

    def test_fresh_begins_anew_where_the_registry_is_broken(self):
        """Cut off anywhere, or no JSON at all: that it is a base is told by how it begins, or by the concepts beside it."""
        path = self.work / "study.base/base.json"
        for text, concepts in ((f"A = {MATERIAL}\n", ["material_1"]), ("", [])):
            self.ok(self.run_study(f"DEBUT()\n{text}FIN()\n", "--fresh"))
            whole = path.read_bytes()
            for broken in (whole[:-1], whole[:60], whole[:8], b"", bytes(4096), *[b"no JSON", b"\xff\xfe{", b'{"format": ,'] * bool(concepts)):
                path.write_bytes(broken)
                self.refused(self.run_study("DEBUT()\nFIN()\n"), "STUDY_6", "base.json", "--fresh")
                self.assertEqual(self.entries(), concepts)
                self.ok(self.run_study("DEBUT()\nFIN()\n", "--fresh"))
                self.assertEqual((self.entries(), self.registry()["labels"]), ([], {}))
                self.ok(self.run_study(f"DEBUT()\n{text}FIN()\n", "--fresh"))

    def test_a_registry_without_its_seal(self):
        self.ok(self.run_study(STUDY + "FIN()\n"))
        content = self.registry()
        del content["seal"]
        (self.work / "study.base/base.json").write_text(json.dumps(content))
        self.refused(self.run_study("POURSUITE()\nFIN()\n"), "STUDY_6", "base.json", "has changed")
        content["format"] = 1  # of earlier versions, which had none
        (self.work / "study.base/base.json").write_text(json.dumps(content))
        self.ok(self.run_study("POURSUITE()\nprint(M)\nFIN()\n"))
        self.assertEqual((self.registry()["format"], "seal" in self.registry()), (2, True))

    def test_a_registry_of_another_layout(self):
        self.ok(self.run_study(STUDY + "FIN()\n"))
        for old, new, key in (('"M0": "mesh_3"', '"M0": 1', "labels"), ('"M0": "mesh_3"', '"M0": "../mesh"', "labels"), ('"next": ', '"next": 0.', "next"),
                              ('"running": false', '"running": true', "running"), ('"running": false', '"running": {"process": "1"}', "running"),
                              ('"sources": [', '"sources": [1, ', "sources"), ('"made": {', '"made": {"mesh_99": [{"key": "a"}], ', "made"),
                              ('"made": {', '"more": {}, "made": {', "more"), ('"running": false', '"unfinished": {"result_99": {"label": "R"}}', "unfinished"),
                              ('"running": false', '"begun": {"files": [], "at": {"mesh_1": "0"}}', "begun"), ('"lost": {}', '"lost": {"A": 1}', "namespace"),
                              ('"running": false', '"unused_contacts": {"contact_9": {}}', "unused_contacts")):
            text = self.change(old, new, seal=True)
            self.refused(self.run_study("POURSUITE()\nFIN()\n"), "STUDY_6", "base.json", f"'{key}'")
            (self.work / "study.base/base.json").write_text(text)

    def test_a_folder_that_is_not_a_base_is_not_emptied(self):
        """Its base.json is another program's, and so are the rest of its files, whatever their names are."""
        other = self.work / "other"
        (other / "run_1").mkdir(parents=True)
        (other / "mesh_1.h5").write_bytes(b"a mesh of its own, longer than any seal is")
        for text in ('{"name": "other"}', "{", "[1]", "", '{"format": 1, "name"', "no JSON"):
            (other / "base.json").write_text(text)
            self.refused(self.run_study("DEBUT()\nFIN()\n", "--base", other, "--fresh"), "STUDY_4", "is not a base")
            self.assertEqual((other / "base.json").read_text(), text)
            self.assertEqual(sorted(os.listdir(other)), ["base.json", "mesh_1.h5", "run_1"])
        (other / "run_1").rmdir()
        (other / "mesh_1.h5").unlink()
        (other / "base.json").write_text("no JSON")
        self.refused(self.run_study("DEBUT()\nFIN()\n", "--base", other, "--fresh"), "STUDY_4", "is not a base")

    def test_a_disk_that_can_only_be_read(self):
        """A mount of its own, where the system lets us make one."""
        self.ok(self.run_study("DEBUT()\nFIN()\n"))
        mount = ["unshare", "-rm", "sh", "-c", 'mount --bind . . && cd "$PWD" && mount -o remount,bind,ro "$PWD" && cd "$PWD" && exec "$@"', "sh"]
        if subprocess.run([*mount, "true"], cwd=self.work, capture_output=True).returncode:
            self.skipTest("no mounts here")
        for options in ((), ("--fresh",), ("--base", "new")):
            env = {**os.environ, "PYTHONPATH": str(ROOT / "commands"), "LACON_BIN": str(self.bin), "PYTHONDONTWRITEBYTECODE": "1"}
            run = subprocess.run([*mount, sys.executable, "-m", "lacon", "study.comm", *options], cwd=self.work, env=env, capture_output=True, text=True)
            self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
            self.assertIn("<STUDY_3>", run.stderr)
            self.assertIn("Read-only file system", run.stderr)
            self.assertNotIn("Traceback", run.stderr)

    def test_two_runs_at_once(self):
        self.ok(self.run_study("DEBUT()\nFIN()\n"))
        handle = os.open(self.work / "study.base", os.O_RDONLY)
        fcntl.flock(handle, fcntl.LOCK_EX)
        try:
            self.refused(self.run_study("DEBUT()\n"), "STUDY_5", f"(process {os.getpid()})")
        finally:
            os.close(handle)

    def test_an_operator_that_does_not_end_with_the_launcher_holds_the_base(self):
        program = self.bin / "lire_maillage"
        program.write_text(f"#!{sys.executable}\nimport os, signal, sys, time\nos.kill(os.getppid(), signal.SIGKILL)\n"
                           "open(sys.argv[1] + '.pid', 'w').write(str(os.getpid()))\ntime.sleep(30)\n")
        self.assertEqual(self.run_study("DEBUT()\nM = LIRE_MAILLAGE()\n", output=False).status, -signal.SIGKILL)
        try:
            run = self.run_study("DEBUT()\n")  # the launcher that is entered is gone: who wants to end what holds the base needs the operator
            (found,) = self.orders.glob("*.pid")
            self.refused(run, "STUDY_46", "since 20", "has ended", f"(process {found.read_text()})")
        finally:
            deadline = time.monotonic() + 20
            while not (found := list(self.orders.glob("*.pid"))) and time.monotonic() < deadline:
                time.sleep(0.02)
            os.kill(int(found[0].read_text()), signal.SIGKILL)

    def test_commands_before_debut_and_after_fin(self):
        self.refused(self.run_study(f"A = {MATERIAL}\n"), "STUDY_11", "study.comm:1")
        self.refused(self.run_study(f"DEBUT()\nFIN()\nA = {MATERIAL}\n"), "STUDY_12", "study.comm:3", "study.comm:2")
        self.refused(self.run_study("DEBUT()\nDEBUT()\n"), "STUDY_9", "study.comm:2")


class CleanUp(LauncherTest):
    def test_fin_removes_what_nothing_refers_to(self):
        self.ok(self.run_study(STUDY + "M0 = None\nMO = None\nR = None\nFIN()\n"))
        left = self.entries()
        self.assertIn("mesh_4", left)
        self.assertNotIn("mesh_3", left, "the uncut mesh has neither a variable nor a model")
        self.assertFalse([e for e in left if e.startswith("result")])
        self.assertTrue([e for e in left if e.startswith("model")], "the load refers to the model, and the model to the mesh")

    def test_fin_follows_references_of_references(self):
        self.ok(self.run_study(STUDY + "for name in ('L', 'RAMP', 'M0', 'M', 'MO', 'MAT', 'CM', 'BC'):\n    del globals()[name]\nFIN()\n"))
        self.assertEqual(set(self.registry()["labels"]), {"R"})
        kinds = {e.rpartition("_")[0] for e in self.entries()}
        self.assertEqual(kinds, {"result", "model", "mesh", "material_field", "material", "load", "function", "list_of_reals"})

    def test_without_fin_nothing_is_removed(self):
        self.ok(self.run_study(f"DEBUT()\nA = {MATERIAL}\nA = {MATERIAL}\n"))
        self.assertEqual(self.entries(), ["material_1", "material_2"])

    def test_fin_removes_leftovers(self):
        self.ok(self.run_study("DEBUT()\nFIN()\n"))
        base = self.work / "study.base"
        (base / "mesh_9.h5.partial").write_text("half")
        (base / "result_8").mkdir()
        (base / "result_8" / "DEPL_1.h5").write_text("a killed operator's")
        self.ok(self.run_study("POURSUITE()\nFIN()\n"))
        self.assertEqual(self.entries(), [])

    def test_fields_that_the_index_does_not_name_are_removed(self):
        self.ok(self.run_study(STUDY + "FIN()\n"))
        folder = next((self.work / "study.base").glob("result_*"))
        before = sorted(p.name for p in folder.iterdir())
        (folder / "SIEF_NOEU_1.h5").write_text("of a killed CALC_CHAMP")
        self.ok(self.run_study("POURSUITE()\nFIN()\n"))
        self.assertEqual(sorted(p.name for p in folder.iterdir()), before)

    def test_destruction(self):
        text = f"DEBUT()\nA = {MATERIAL}\nL = [{MATERIAL}, {MATERIAL}]\nB = {MATERIAL}\nDETRUIRE(CONCEPT=_F(NOM=(A, L[0])))\nDETRUIRE(NOM=B)\n"
        self.ok(self.run_study(text + "assert 'A' not in globals()\nFIN()\n"))
        self.assertEqual(self.registry()["labels"], {"L[1]": "material_3"})
        self.assertEqual(self.entries(), ["material_3"])

    def test_a_destroyed_concept_is_refused_with_the_place(self):
        text = STUDY + "held = [M0]\nDETRUIRE(NOM=M0)\nN = CREA_MAILLAGE(MAILLAGE=held[0], LINE_QUAD=_F(TOUT='OUI'))\n"
        self.refused(self.run_study(text), "KEYWORD_14", "M0", "destroyed at study.comm:13")
        text = STUDY + "held = [R]\nDETRUIRE(NOM=R)\nheld[0].getField('DEPL', 1)\n"
        self.refused(self.run_study(text), "KEYWORD_14", "R", "destroyed at study.comm:13")

    def test_destruction_keeps_what_others_refer_to(self):
        self.ok(self.run_study(STUDY + "DETRUIRE(NOM=(M, MO))\nX = AFFE_CHAR_CINE\nFIN()\n"))
        self.assertTrue({"mesh_4", "model_5"} <= set(self.entries()))
        self.assertNotIn("M", self.registry()["labels"])


class Failures(LauncherTest):
    def state(self):
        base = self.work / "study.base"
        return {str(p.relative_to(base)): p.read_bytes() for p in sorted(base.rglob("*")) if p.is_file() and p.name != "base.json"}

    def check_untouched(self, behaviour, line, *words, status=2, diagnostic="<F>_ERROR"):
        """A second run that fails at `line` leaves every concept, and every label, as they were."""
        self.ok(self.run_study(STUDY + "FIN()\n"))
        before, labels = self.state(), self.registry()["labels"]
        run = self.refused(self.run_study(f"POURSUITE()\n{line}\n", behaviour=behaviour), *words, status=status, diagnostic=diagnostic)
        self.assertEqual(self.state(), before)
        self.assertEqual(self.registry()["labels"], labels)
        return run

    NEW = "M2 = CREA_MAILLAGE(MAILLAGE=M, LINE_QUAD=_F(TOUT='OUI'))"
    REUSE = "MODI_MAILLAGE(reuse=M, MAILLAGE=M, ORIE_PEAU=_F(GROUP_MA_PEAU='SKIN'))"

    def test_an_operator_refuses(self):
        error = {"severity": "F", "id": "MESH_1", "text": "unknown group 'X'", "do": "look"}
        run = self.check_untouched({"crea_maillage": {"status": 2, "messages": [error], "lazy": True}}, self.NEW, "unknown group 'X'",
                                   "    where: CREA_MAILLAGE, study.comm:2")
        self.assertEqual(run.err.count("MESH_1"), 1, "said once")

    def test_an_operator_is_killed_half_way(self):
        for number in (signal.SIGKILL, signal.SIGSEGV):
            self.check_untouched({"crea_maillage": {"kill": int(number), "half": True}}, self.NEW, "INTERNAL_3", "crea_maillage",
                                 signal.Signals(number).name, "study.comm:2", status=4, diagnostic="<F>_ABNORMAL_ABORT")

    def test_an_operator_is_killed_after_it_replaced_a_concept(self):
        self.check_untouched({"modi_maillage": {"kill": 9}}, self.REUSE, "INTERNAL_3", status=4, diagnostic="<F>_ABNORMAL_ABORT")

    def test_an_operator_fails_after_it_replaced_a_concept(self):
        self.check_untouched({"modi_maillage": {"status": 2}}, self.REUSE, "COMMAND_6")
        self.check_untouched({"calc_champ": {"status": 3}}, "CALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')", "COMMAND_7",
                             status=3, diagnostic="<S>_NO_CONVERGENCE")

    def test_an_operator_makes_no_result(self):
        self.check_untouched({"crea_maillage": {"lazy": True}}, self.NEW, "INTERNAL_3", "is not there", status=4,
                             diagnostic="<F>_ABNORMAL_ABORT")

    def test_an_operator_that_is_not_installed(self):
        (self.bin / "crea_maillage").unlink()
        self.refused(self.run_study(STUDY), "INTERNAL_2", "crea_maillage", status=4, diagnostic="<F>_ABNORMAL_ABORT")

    def test_an_alarm_as_an_exception_undoes_the_command(self):
        alarm = {"severity": "A", "id": "MODELISA_1", "text": "beware", "do": ""}
        self.ok(self.run_study(STUDY + "FIN()\n"))
        before = self.state()
        for line in (self.NEW, self.REUSE):
            behaviour = {"crea_maillage": {"messages": [alarm]}, "modi_maillage": {"messages": [alarm]}}
            self.refused(self.run_study(f"POURSUITE(ERREUR=_F(ALARME='EXCEPTION'))\n{line}\n", behaviour=behaviour), "<F> <MODELISA_1>")
            self.assertEqual(self.state(), before)


if __name__ == "__main__":
    unittest.main()
