#!/usr/bin/python3
"""Completion in real shells, on a terminal: types a line, presses keys, and prints the words that the line then has.

complete.py bash|zsh|fish FOLDER LINE…     FOLDER: where the files of completion are installed for that shell

For each LINE two lines are printed: what the key of completion makes of it, as words in <>, and after "all:" the words
that all candidates together make of the last one."""
import os
import pty
import select
import subprocess
import sys
import time

SETUP = {
    "bash": "for f in '{folder}'/retex*; do . \"$f\"; done; bind 'set bell-style none'",
    "zsh": "fpath=('{folder}' $fpath); autoload -Uz compinit; compinit -u -D; zstyle ':completion:*' completer _complete; "
           "zle -C every complete-word _generic; bindkey '^[*' every; bindkey '^A' beginning-of-line; "
           "zstyle ':completion:every:*' completer _all_matches _complete; zstyle ':completion:every:*' insert yes",
    "fish": "set -p fish_complete_path '{folder}'; function fish_prompt; end; bind \\e\\* true",
}
START = {"bash": ["bash", "--norc", "--noprofile", "-i"], "zsh": ["zsh", "-f", "-i"],
         "fish": ["fish", "--no-config", "-i"]}
DEADLINE = 60


class Shell:
    def __init__(self, name, folder):
        self.child, self.terminal = pty.fork()
        if self.child == 0:
            os.environ.update(TERM="dumb", PS1="", HISTFILE="/dev/null")
            os.execvp(START[name][0], START[name])
        self.text = ""
        self.number = 0
        self.type(SETUP[name].format(folder=folder) + "\r")
        self.ask("")

    def type(self, keys):
        os.write(self.terminal, keys.encode())

    def ask(self, keys):
        """Turn the line into arguments of a command that prints them, and return what it prints."""
        self.number += 1
        begin, end = f"B{self.number}B", f"E{self.number}E"
        self.type(keys + "\x01printf '<%s>' " + f"{begin[:-1]}''B " + "\x05 " + f"{end[:-1]}''E\r")
        until = time.monotonic() + DEADLINE
        while f"<{end}>" not in self.text:
            ready, _, _ = select.select([self.terminal], [], [], max(0, until - time.monotonic()))
            if not ready:
                sys.exit(f"no answer to {keys!r}: {self.text[-2000:]!r}")
            self.text += os.read(self.terminal, 65536).decode(errors="replace")
        answer = self.text[self.text.rindex(f"<{begin}>") + len(begin) + 2:self.text.rindex(f"<{end}>")]
        self.text = ""
        return answer.replace("\r", "").replace("\n", "").replace(os.getcwd(), "HOME")


def main():
    name, folder, *lines = sys.argv[1:]
    os.environ.update(HOME=os.getcwd(), LC_ALL="C.UTF-8")
    if name == "fish":
        for line in lines:
            command = f"set -p fish_complete_path '{folder}'; complete -C {line!r}"
            answer = subprocess.run(["fish", "--no-config", "-c", command], capture_output=True, text=True, check=True,
                                    stdin=subprocess.DEVNULL)
            print(f"{line}: {' '.join(sorted(row.split(chr(9))[0] for row in answer.stdout.splitlines()))}")
        return
    shell = Shell(name, folder)
    for line in lines:
        print(f"{line}: {shell.ask(line + chr(9))}")
        print(f"    all: {shell.ask(line + chr(27) + '*')}")


main()
