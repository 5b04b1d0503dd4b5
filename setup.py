"""Adds the filter scripts, which are a folder of their own, to what is installed."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

SCRIPTS = "filter_scripts"


class BuildWithScripts(build_py):
    def run(self):
        super().run()
        # An editable installation finds them in the checkout.
        if not self.editable_mode:
            folder = Path(self.build_lib, "meshlab_willmore", SCRIPTS)
            folder.mkdir(parents=True, exist_ok=True)
            for script in sorted(Path(__file__).with_name(SCRIPTS).glob("*.mlx")):
                shutil.copy(script, folder)


setup(cmdclass={"build_py": BuildWithScripts})
