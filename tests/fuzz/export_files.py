"""Export files and command files that were changed at random: the launcher ends with a status and a message, never with a traceback of its
own. In the process of the test, since a launcher for each would take long."""

import contextlib
import io
import os
import pathlib
import random
import sys
import tempfile
import time
import traceback
import unittest

SOURCE = pathlib.Path(os.environ.get("LACON_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "commands"))
from lacon.core import checker, current, messages, plugins  # noqa: E402
from lacon.core.concepts import _F  # noqa: E402
from lacon.run import execution, export, study  # noqa: E402

EXPORT = """# a comment
P time_limit 60
P ncpus 2
A memjeveux 4
F comm study.comm D 1
F com1 more.com1 D 1
F mmed mesh with blanks.med D 20
F rmed result.rmed R 80
F nom data.txt D 0
F base here.base DR 0
"""
COMMANDS = """DEBUT(LANG='FR')
L = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=(_F(JUSQU_A=1.0, NOMBRE=2), _F(JUSQU_A=2.0, PAS=0.5)))
RAMP = DEFI_FONCTION(NOM_PARA='INST', VALE=(0.0, 0.0, 1.0, 1.0), PROL_DROITE='CONSTANT')
F = FORMULE(NOM_PARA=('X', 'Y'), VALE='sin(X) + RAMP(Y)', RAMP=RAMP)
T = CREA_TABLE(LISTE=(_F(PARA='A', LISTE_R=(1.0, 2.0)), _F(PARA='B', LISTE_K=('x', 'y'))))
T = CALC_TABLE(reuse=T, TABLE=T, ACTION=_F(OPERATION='FILTRE', NOM_PARA='A', VALE=1.0))
TEST_TABLE(TABLE=T, NOM_PARA='A', VALE_CALC=1.0, FILTRE=_F(NOM_PARA='B', VALE_K='x'))
MAT = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3))
FIN()
"""
NUMBERS = ("0", "-1", "1e400", "99999999999999999999", "nan", "None", "()", "''", "*", "[[1]]", "'\\x00'")


def changed(text, chance):
    for _ in range(chance.randint(1, 3)):
        at = chance.randrange(len(text) + 1)
        size = min(chance.randint(1, 12), len(text) - at)
        match chance.randrange(5):
            case 0:
                text = text[:at] + text[at + size:]
            case 1:
                text = text[:at] + text[at:at + size] + text[at:]
            case 2:
                text = text[:at] + chance.choice(NUMBERS) + text[at + size:]
            case 3:
                text = text[:at] + chr(chance.choice((0, 9, 10, 32, 39, 40, 95, 233, 0x2028, 0xD7FF))) + text[at:]
            case _:
                lines = text.splitlines(keepends=True)
                chance.shuffle(lines)
                text = "".join(lines)
    return text


def seconds():
    return float(os.environ.get("FUZZ_SECONDS", "2"))


def until_over(seed=1):
    """Random numbers, again and again until the time is over. @return counts them"""
    end, chance = time.monotonic() + seconds(), random.Random(int(os.environ.get("FUZZ_SEED", seed)))
    while time.monotonic() < end:
        yield chance


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="lacon_fuzz_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_export_files(self):
        path, runs = self.folder / "study.export", 0
        for chance in until_over():
            text = changed(EXPORT, chance)
            path.write_text(text, encoding="utf-8")
            runs += 1
            try:
                export.read_export(path)
            except messages.AsterError:
                pass
            except Exception:  # what is found is to be told with its input
                self.fail(f"{text!r}\n{traceback.format_exc()}")
        print(f"{runs} changes of an export file", file=sys.stderr)

    def test_command_files(self):
        """Whatever stops a command file stops it as an error of the user's, told with its line."""
        path, runs = self.folder / "study.comm", 0
        names = execution.provided_names()
        for chance in until_over():
            text = changed(COMMANDS, chance)
            path.write_text(text, encoding="utf-8")
            runs += 1
            log = io.StringIO()
            run = current.study = study.Study(self.folder / "study.base", {}, True, provided=dict(names))
            try:
                with contextlib.redirect_stdout(log), contextlib.redirect_stderr(log):
                    try:
                        execution.run_files(run, [path])
                    finally:
                        run.close()
            except (execution.Failure, messages.AsterError):
                self.assertNotIn(str(SOURCE / "commands"), log.getvalue(), text)
            except Exception:
                self.fail(f"{text!r}\n{traceback.format_exc()}")
            finally:
                current.study = None
        print(f"{runs} changes of a command file", file=sys.stderr)

    def test_keywords(self):
        """The checker takes any Python value for any keyword."""
        values = (None, 0, -1, 1e308, float("nan"), "", "OUI", (), [], ((1.0,),), {}, _F(), _F(A=1), b"", object(), True, 10**400, [_F(), 1], "x" * 100)
        runs = 0
        commands = [(name, plugins.command(name)) for name in ("DEFI_CONTACT", "STAT_NON_LINE", "AFFE_CHAR_MECA", "CALC_CHAMP", "IMPR_RESU", "DEFI_LIST_INST")]
        for chance in until_over():
            name, row = chance.choice(commands)
            keywords = list(row["keyword"])
            given = {chance.choice(keywords): chance.choice(values) for _ in range(chance.randint(1, 4))}
            factors = [keyword for keyword in keywords if row["keyword"][keyword]["type"] == "factor"]
            if factors:
                factor = chance.choice(factors)
                own = list(row["keyword"][factor]["keyword"])
                given[factor] = _F(**{chance.choice(own): chance.choice(values) for _ in range(3)} if own else {})
            runs += 1
            try:
                checker.complete(name, row, given, "study.comm:1")
            except messages.AsterError:
                pass
            except Exception:
                self.fail(f"{name} {given!r}\n{traceback.format_exc()}")
        print(f"{runs} sets of keywords", file=sys.stderr)


if __name__ == "__main__":
    unittest.main()
