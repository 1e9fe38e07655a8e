"""What the tests of the package retex share: the build's library and programs, an own folder, TAP."""
import atexit
import os
import shutil
import subprocess
import sys
import tempfile
import traceback

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
BUILD = os.path.abspath(os.path.join(ROOT, os.environ.get("BUILD", "build")))
LIBRARY = os.path.join(BUILD, "lib", "libretex.so.2")
PACKAGE = os.path.join(ROOT, "tools", "python")
SCENES = os.path.join(ROOT, "scenes")

os.environ["RETEX_LIBRARY"] = LIBRARY
os.environ["PYTHONPATH"] = PACKAGE
os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
os.environ["PATH"] = f"{BUILD}/bin:{BUILD}/tests/bin:{os.environ['PATH']}"
sys.path.insert(0, PACKAGE)

FOLDER = tempfile.mkdtemp()
atexit.register(shutil.rmtree, FOLDER)
os.chdir(FOLDER)


def run(*command, **options):
    """Run a program, which must succeed; return its standard output."""
    return subprocess.run(command, check=True, capture_output=True, text=True, **options).stdout


def fails(kind, function, *arguments, **options):
    """The exception of that kind that a call must raise."""
    try:
        function(*arguments, **options)
    except kind as error:
        return error
    raise AssertionError(f"{kind.__name__} expected")


def main(names):
    """Run all test_… functions of a module, in their order."""
    tests = [(name, value) for name, value in names.items() if name.startswith("test_")]
    print(f"1..{len(tests)}")
    for number, (name, test) in enumerate(tests, 1):
        title = (test.__doc__ or name).split("\n")[0].rstrip(".")
        try:
            test()
            print(f"ok {number} - {title}", flush=True)
        except Exception:  # all failures are reported
            print(f"not ok {number} - {title}")
            print("".join("# " + line + "\n" for line in traceback.format_exc().splitlines()), end="", flush=True)
