#!/usr/bin/python3
"""The pictures of `lacon report` in the documentation: runs three studies of `lacon new --template`, opens their pages in headless Chromium.

    python3 commands/viewer/pictures.py build/release docs
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
#: template -> what is chosen before its picture is taken
STUDIES = {"bolted_flange": {}, "indentation": {"field": "CONT_ELEM"}, "several_zones": {"field": "CONT_ELEM", "opening": 1}}


def page_of(lacon, template, folder):
    """Run a template in a folder. @return its page"""
    subprocess.run([lacon, "new", "--template", template, "--out", folder / template], check=True, stdout=subprocess.DEVNULL)
    [command_file] = (folder / template).glob("*.comm")
    subprocess.run([lacon, command_file.name], cwd=folder / template, check=True, stdout=subprocess.DEVNULL)
    [base] = (folder / template).glob("*.base")
    subprocess.run([lacon, "report", base.name, "--out", "page.html"], cwd=folder / template, check=True)
    return folder / template / "page.html"


def main(build, target):
    build, target = pathlib.Path(build).resolve(), pathlib.Path(target).resolve()
    with tempfile.TemporaryDirectory(prefix="lacon_pictures_") as work:
        steps = []
        for template, chosen in STUDIES.items():
            page = page_of(build / "bin/lacon", template, pathlib.Path(work))
            steps += [{"open": str(page), "width": 1280, "height": 760}, {"set": chosen}, {"shot": str(target / f"report_{template}.png")}]
        done = subprocess.run([shutil.which("node") or "nodejs", SOURCE / "tests/studies/report_page.mjs", build / "commands/viewer", shutil.which("chromium")],
                              input="".join(json.dumps(step) + "\n" for step in steps), text=True, stdout=subprocess.PIPE, check=True, env=os.environ)
    failed = [line for line in done.stdout.splitlines() if "failed" in json.loads(line)]
    sys.exit("\n".join(failed) or None)


if __name__ == "__main__":
    main(*sys.argv[1:])
