"""Jobs of Kubernetes without Kubernetes: cluster-jobs.py FILE.yaml OPTIONS REPLACEMENT

Checks what a Job needs, then runs the container's command for each index, last index first, in the current folder, with
the file's environment and the index. OPTIONS in the commands are replaced, so that less is rendered."""

import os
import subprocess
import sys

import yaml

path, options, replacement = sys.argv[1:]
for job in yaml.safe_load_all(open(path, encoding="utf-8")):
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
    indices = [None]
    if spec.get("completionMode") == "Indexed":
        assert int(environment["SHARDS"]) == spec["completions"] >= spec["parallelism"]
        assert spec["backoffLimitPerIndex"] and pod["restartPolicy"] == "Never"  # which it requires
        indices = list(reversed(range(spec["completions"])))
    (script,) = container["args"]
    assert not options or options in script, script
    for index in indices:
        variables = dict(os.environ, **environment)
        if index is not None:
            variables["JOB_COMPLETION_INDEX"] = str(index)
        command = container["command"] + [script.replace(options, replacement) if options else script]
        subprocess.run(command, env=variables, check=True)
