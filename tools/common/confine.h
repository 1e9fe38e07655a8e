/* Takes from a process what it does not need, for ever, so that somebody who gets hold of it by a broken file gets
 * little. Two layers of the kernel, each if it has it: a filter of system calls (seccomp), and Landlock. */
#ifndef RETEX_CONFINE_H
#define RETEX_CONFINE_H

#include <stdint.h>
#include <sys/resource.h>

/* The layers that a call below could set up. */
enum { CONFINE_CALLS = 1, CONFINE_FILES = 2 };

/* Nothing but to compute, start threads, read files that are open, and write to standard output. */
int confine_to_open_files(void);

/* Besides: to read files, to load libraries, to write to files that are open, and to make, change and remove files
 * below one open folder, wherever its name leads by then; below none if it is -1; without Landlock, wherever the user
 * may. No modes, owners and times of files, no sockets, no programs. */
int confine_to_folder(int folder);

/* Only of files: to make, change and remove them below an open folder, whatever has its name by then, and to write to
 * /dev/null. It may start programs, which are confined as it is, but not use the network. Without Landlock nothing is
 * forbidden: 0. May be called between fork(2) and execve(2) in a process with threads. */
int confine_writes_to(int folder);

/* Lower a limit of setrlimit(2), as far as it is not lower. */
void confine_limit(int what, uint64_t most);
/* Limit the memory to what is mapped now and so many bytes more. */
void confine_memory(uint64_t bytes);

#endif
