"""tools/serve/retex-serve.service: systemd reads it, and finds little that the server could do beyond its work."""
import os
import re
import shutil
import subprocess

from serving import Tap

EXPOSURE_MAX = 20  # tenths: systemd's judgement from 0, nothing, to 100, everything


def check(work):
    if not shutil.which("systemd-analyze"):
        Tap.skip("the unit file", "systemd-analyze is not installed")
        return
    path = os.path.join(work, "retex-serve.service")
    with open("tools/serve/retex-serve.service", encoding="utf-8") as file:
        text = file.read()
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace("/usr/local/bin/retex-serve", shutil.which("retex-serve")))
    help_text = subprocess.run(["retex-serve", "--help"], stdout=subprocess.PIPE, text=True, check=True).stdout
    deadline = int(re.search(r"--deadline .*?default (\d+)", help_text, re.S)[1])
    stop = int(re.search(r"^TimeoutStopSec=(\d+)$", text, re.M)[1])
    Tap.result(stop >= deadline + 10, "systemd waits until the last picture is made and sent", f"{stop} {deadline}")
    verify = subprocess.run(["systemd-analyze", "--man=no", "verify", path], stderr=subprocess.PIPE, text=True)
    Tap.result(verify.returncode == 0 and not verify.stderr.strip(), "systemd-analyze verify: no complaint",
               verify.stderr)
    judged = subprocess.run(["systemd-analyze", "security", "--offline=true", f"--threshold={EXPOSURE_MAX}", path],
                            stdout=subprocess.PIPE, text=True)
    exposure = re.search(r"exposure level for \S+: ([\d.]+)", judged.stdout)
    Tap.note(f"systemd-analyze security: exposure {exposure and exposure[1]} of 10")
    Tap.result(judged.returncode == 0, "systemd-analyze security: little is exposed")
