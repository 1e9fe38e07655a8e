"""Installing by pip, without a network; and where the library is looked for."""
import os
import shutil
import subprocess
import sys

import lib

shutil.copytree(lib.PACKAGE, "source", ignore=shutil.ignore_patterns("__pycache__"))
lib.run("make_set", "room.exr", "64", "48")
PROGRAM = "import retex; print(retex.__file__, retex.open('room.exr').targets[0].name)"


def python(program, **environment):
    """Run Python with this environment; its exit status, output and last line of error."""
    kept = {name: value for name, value in os.environ.items()
            if name not in ("PYTHONPATH", "RETEX_LIBRARY", "LD_LIBRARY_PATH")}
    done = subprocess.run([sys.executable, "-c", program], env={**kept, **environment}, capture_output=True, text=True,
                          check=False)
    return done.returncode, done.stdout.strip(), done.stderr.strip().split("\n")[-1]


def test_pip():
    """pip installs it with Debian's setuptools alone"""
    lib.run(sys.executable, "-m", "pip", "install", "-q", "--no-build-isolation", "--no-index", "--no-deps",
            "--target", "site", "./source", env={**os.environ, "PIP_DISABLE_PIP_VERSION_CHECK": "1", "HOME": os.getcwd()})
    files = sorted(os.listdir("site/retex"))
    assert [name for name in files if name != "__pycache__"] == \
        sorted(name for name in os.listdir(lib.PACKAGE + "/retex") if name != "__pycache__"), files
    assert "py.typed" in files
    assert "retex-0.1.0.dist-info" in os.listdir("site")


def test_named():
    """The library that $RETEX_LIBRARY names"""
    status, output, _ = python(PROGRAM, PYTHONPATH="site", RETEX_LIBRARY=lib.LIBRARY)
    assert status == 0 and output == os.path.abspath("site/retex/__init__.py") + " Floor", output


def test_loader():
    """The library that the loader finds"""
    status, output, _ = python(PROGRAM, PYTHONPATH="site", LD_LIBRARY_PATH=os.path.dirname(lib.LIBRARY))
    assert status == 0 and output.endswith(" Floor"), output


def test_beside():
    """The library beside the package, before the loader's"""
    shutil.copytree("site", "own")
    shutil.copy(lib.LIBRARY, "own/retex/libretex.so.2")
    program = PROGRAM + "; print(retex.library.lib._name)"
    status, output, _ = python(program, PYTHONPATH="own", LD_LIBRARY_PATH=os.path.dirname(lib.LIBRARY))
    assert status == 0 and output.endswith("Floor\n" + os.path.abspath("own/retex/libretex.so.2")), output


def test_missing():
    """Without a library: one line that says what to do"""
    for environment in ({"RETEX_LIBRARY": "/nonexistent/libretex.so.2"}, {"RETEX_LIBRARY": os.path.abspath("room.exr")}):
        status, _, error = python("import retex", PYTHONPATH="site", **environment)
        assert status == 1 and error.startswith("ImportError: retex needs the C library libretex.so.2"), error
        assert environment["RETEX_LIBRARY"] in error and "make install" in error and "$RETEX_LIBRARY" in error


def test_another_version():
    """A library without a call that the package needs"""
    with open("other.c", "w", encoding="utf-8") as file:
        file.write("int retex_image_alloc(void) { return 0; }\n")
    lib.run("gcc", "-shared", "-fPIC", "other.c", "-o", "libother.so")
    status, _, error = python("import retex", PYTHONPATH="site", RETEX_LIBRARY=os.path.abspath("libother.so"))
    assert status == 1 and error.startswith("ImportError") and "another version" in error, error


lib.main(globals())
