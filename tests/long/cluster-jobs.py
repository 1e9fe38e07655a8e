"""Jobs of Kubernetes without Kubernetes: cluster-jobs.py FILE.yaml

Checks what an Indexed Job needs, then runs the container's command for each index, last index first, in the current
folder, with the file's environment and the index."""

import os
import subprocess
import sys

import yaml

for job in yaml.safe_load_all(open(sys.argv[1], encoding="utf-8")):
    spec, pod = job["spec"], job["spec"]["template"]["spec"]
    assert (job["apiVersion"], job["kind"]) == ("batch/v1", "Job"), job["kind"]
    assert pod["restartPolicy"] in ("Never", "OnFailure")
    (container,) = pod["containers"]
    assert container["image"] and container["command"] == ["sh", "-ec"], container
    volumes = {volume["name"] for volume in pod["volumes"]}
    mounts = {mount["name"]: mount["mountPath"] for mount in container["volumeMounts"]}
    assert set(mounts) == volumes and container["workingDir"] in mounts.values()
    environment = {entry["name"]: entry["value"] for entry in container["env"]}
    assert all(isinstance(value, str) for value in environment.values()), "values of env must be strings"
    assert spec["completionMode"] == "Indexed"
    assert int(environment["SHARDS"]) == spec["completions"] >= spec["parallelism"]
    assert spec["backoffLimitPerIndex"] and pod["restartPolicy"] == "Never"  # which it requires
    (script,) = container["args"]
    for index in reversed(range(spec["completions"])):
        variables = dict(os.environ, **environment, JOB_COMPLETION_INDEX=str(index))
        subprocess.run(container["command"] + [script], env=variables, check=True)
