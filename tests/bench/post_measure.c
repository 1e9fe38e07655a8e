/* One run of a program, or of several in a pipe, timed: post_measure RECORD PROGRAM ARGUMENT... ['|' PROGRAM ...]
 *
 * Writes to the file RECORD, as a JSON object, the wall seconds from before the first is started until the last has
 * ended, and of each process its processor seconds, its peak memory and its exit status. What starts a process counts
 * in the peak that the kernel tells of it, so this is small and does nothing else. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { PROCESSES_MAX = 8 };

typedef struct Process {
    char **arguments; /* NULL-terminated */
    pid_t pid;
    int status;
    double cpu;
    long peak_kilobytes;
} Process;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double seconds(struct timeval t)
{
    return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

/* Cut the arguments at each '|'; how many processes that makes. */
static int parse(char **arguments, Process *processes)
{
    int count = 0;
    processes[count++].arguments = arguments;
    for (; *arguments; arguments++)
        if (strcmp(*arguments, "|") == 0 && count < PROCESSES_MAX) {
            *arguments = NULL;
            processes[count++].arguments = arguments + 1;
        }
    return count;
}

/* Reading from the pipe before it, if any, and writing to that behind it. */
static int start(Process *process, int in, int out)
{
    process->pid = fork();
    if (process->pid != 0)
        return process->pid > 0;
    if ((in >= 0 && dup2(in, STDIN_FILENO) < 0) || (out >= 0 && dup2(out, STDOUT_FILENO) < 0))
        _exit(126);
    execvp(process->arguments[0], process->arguments);
    perror(process->arguments[0]);
    _exit(127);
}

static int start_all(Process *processes, int count)
{
    int in = -1;
    for (int i = 0; i < count; i++) {
        int ends[2] = {-1, -1};
        if (i + 1 < count && pipe2(ends, O_CLOEXEC))
            return 0;
        int started = start(&processes[i], in, ends[1]);
        if (in >= 0)
            close(in);
        if (ends[1] >= 0)
            close(ends[1]);
        in = ends[0];
        if (!started)
            return 0;
    }
    return 1;
}

static void wait_for(Process *process)
{
    struct rusage used;
    int status;
    if (wait4(process->pid, &status, 0, &used) < 0) {
        process->status = 127;
        return;
    }
    process->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    process->cpu = seconds(used.ru_utime) + seconds(used.ru_stime);
    process->peak_kilobytes = used.ru_maxrss;
}

int main(int argc, char **argv)
{
    static Process processes[PROCESSES_MAX];
    if (argc < 3) {
        fprintf(stderr, "usage: post_measure RECORD PROGRAM ARGUMENT... ['|' PROGRAM ...]\n");
        return 2;
    }
    const int count = parse(argv + 2, processes);
    const double began = now();
    if (!start_all(processes, count)) {
        perror("post_measure");
        return 2;
    }
    int failed = 0;
    for (int i = 0; i < count; i++)
        wait_for(&processes[i]);
    const double wall = now() - began;
    FILE *record = fopen(argv[1], "w");
    if (!record) {
        perror(argv[1]);
        return 2;
    }
    fprintf(record, "{\"wall\": %.6f, \"processes\": [", wall);
    for (int i = 0; i < count; i++) {
        const Process *p = &processes[i];
        fprintf(record, "%s{\"cpu\": %.6f, \"peak_memory_bytes\": %lld, \"status\": %d}", i ? ", " : "", p->cpu,
                1024LL * p->peak_kilobytes, p->status);
        failed |= p->status != 0;
    }
    fprintf(record, "]}\n");
    if (fclose(record)) {
        perror(argv[1]);
        return 2;
    }
    return failed;
}
