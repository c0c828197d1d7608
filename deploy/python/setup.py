"""What pyproject.toml cannot say: the release is the library's, and the wheel is for any Python 3 of this machine's kind."""

import os

from setuptools import Distribution, setup
from setuptools.command.bdist_wheel import bdist_wheel


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return True  # libvsss.so: it goes where binaries go


class AnyPython(bdist_wheel):
    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


setup(version=os.environ["VSSS_RELEASE"], distclass=WithLibrary, cmdclass={"bdist_wheel": AnyPython})
