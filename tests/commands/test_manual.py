"""What is made of the command lines and the catalogue: shell completion, man pages, pages of commands and messages."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import support
from lacon import main as launcher
from lacon.core import catalog

#: how a shell asks for words: prints what is offered behind these
ASK = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _lacon; printf "%s\\n" "${COMPREPLY[@]}"'


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_manual_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        subprocess.run([sys.executable, "-B", str(support.ROOT / "commands/generate.py"), str(cls.folder)], check=True)
        cls.commands = catalog.command_names()
        for name in ("study.comm", "study.export", "mesh.med", "mesh.mail", "notes.txt"):
            (cls.folder / name).touch()
        (cls.folder / "study.base").mkdir()

    def offered(self, *words):
        """What bash completes the last word to."""
        said = subprocess.run(["bash", "-c", ASK, "bash", str(self.folder / "completion/lacon"), "lacon", *words], cwd=self.folder, capture_output=True,
                              text=True, check=True)
        self.assertEqual(said.stderr, "")
        return set(said.stdout.split())

    def test_bash_offers_tools_files_options_and_values(self):
        self.assertEqual(self.offered("wa"), {"watch"})
        self.assertEqual(self.offered("stu"), {"study.comm", "study.export", "study.base"})
        self.assertEqual(self.offered("study.comm", "--tim"), {"--timings"})
        self.assertEqual(self.offered("help", "defi_con"), {name for name in self.commands if name.startswith("DEFI_CON")})
        self.assertEqual(self.offered("plot", "study.base", "--format", ""), {"png", "svg"})
        self.assertEqual(self.offered("new", "--template", "he"), {"hertz"})
        for tool in ("convert", "new"):  # every format that is read
            self.assertEqual(self.offered(tool, "me"), {"mesh.med", "mesh.mail"})
        self.assertEqual(self.offered("watch", "stu"), {"study.base"})

    def test_every_option_of_every_tool_is_offered(self):
        for tool in launcher.tools:
            if tool != "help":
                self.assertIn("--help", self.offered(tool, "--"), tool)

    @unittest.skipUnless(shutil.which("shellcheck"), "no shellcheck")
    def test_the_completion_of_bash_is_sound(self):
        done = subprocess.run(["shellcheck", "-s", "bash", "-S", "warning", str(self.folder / "completion/lacon")], capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, "")

    @unittest.skipUnless(shutil.which("zsh"), "no zsh")
    def test_the_completion_of_zsh_is_read(self):
        done = subprocess.run(["zsh", "-n", str(self.folder / "completion/_lacon")], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_zsh_offers_files_where_a_file_is_meant(self):
        text = (self.folder / "completion/_lacon").read_text(encoding="utf-8")
        self.assertIn("'watch:", text)
        self.assertIn('_files -g "*.(med|mmed|msh|mail)"', text)
        self.assertEqual(set(re.findall(r":([A-Z=]+):_files", text)), {"FILE", "FOLDER", "N=FILE"})

    def test_every_tool_and_every_command_has_a_man_page(self):
        pages = {"man1/lacon.1", *(f"man1/lacon-{tool}.1" for tool in launcher.tools), *(f"man7/lacon-{name}.7" for name in self.commands)}
        for folder in (self.folder / "man", self.folder / "man/fr"):
            self.assertEqual({str(path.relative_to(folder)) for path in folder.glob("man?/*")}, pages)

    def test_pages_speak_english_and_french(self):
        for page, english, french in (("man1/lacon-watch.1", "Shows how Newton's method", "Montre comment avance la méthode de Newton"),
                                      ("man7/lacon-DEFI_CONTACT.7", ".SH KEYWORDS", ".SH MOTS-CLÉS")):
            for folder, said, unsaid in (("man", english, french), ("man/fr", french, english)):
                text = (self.folder / folder / page).read_text(encoding="utf-8")
                self.assertIn(said, text)
                self.assertNotIn(unsaid, text)

    @unittest.skipUnless(shutil.which("groff"), "no groff")
    def test_man_pages_are_without_fault(self):
        pages = sorted(map(str, self.folder.glob("man/**/*.?")))
        for page in pages:
            done = subprocess.run(["groff", "-man", "-Kutf8", "-Tutf8", "-ww", "-rLL=200n", "-z", page], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""), page)

    def test_the_reference_names_every_keyword_and_message(self):
        for name in self.commands:
            page = (self.folder / f"reference/{name.lower()}.md").read_text(encoding="utf-8")
            keywords = re.findall(r"\* \*\*(\w+)\*\*", page)
            self.assertEqual(keywords, list(every_keyword(catalog.command(name))), name)
        messages = (self.folder / "reference/messages.md").read_text(encoding="utf-8")
        self.assertEqual(set(re.findall(r"^## (\w+)$", messages, re.MULTILINE)), set(catalog.messages()))


def every_keyword(row):
    for name, keyword in row.get("keyword", {}).items():
        yield name
        yield from every_keyword(keyword)


if __name__ == "__main__":
    support.main()
