/* See child.h. */
#include "child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/confine.h"

extern char **environ;

enum { MOST_VARIABLES = 512, NOT_STARTED = 127, PIPE_BYTES = 1 << 20 };

typedef struct Pipes {
    int ends[3][2]; /* of standard input, output and error: for reading, for writing */
} Pipes;

void child_close_file(int *file)
{
    if (*file >= 0)
        close(*file);
    *file = -1;
}

static void close_pipes(Pipes *pipes)
{
    for (int i = 0; i < 3; i++)
        for (int end = 0; end < 2; end++)
            child_close_file(&pipes->ends[i][end]);
}

static int open_pipes(Pipes *pipes, int is_fed, RetexError *err)
{
    for (int i = 0; i < 3; i++)
        pipes->ends[i][0] = pipes->ends[i][1] = -1;
    if (!is_fed)
        pipes->ends[0][0] = open("/dev/null", O_RDONLY | O_CLOEXEC);
    for (int i = is_fed ? 0 : 1; i < 3; i++)
        if (pipe2(pipes->ends[i], O_CLOEXEC) != 0) {
            close_pipes(pipes);
            return retex_fail(err, RETEX_EIO, "cannot make a pipe: %s", strerror(errno));
        }
    return RETEX_OK;
}

/* The environment of the programs: progress is told as JSON; unfinished files of theirs lie where they may write. */
static void make_environment(char *variables[MOST_VARIABLES], char *temporary)
{
    int count = 0;
    for (char **variable = environ; *variable && count < MOST_VARIABLES - 3; variable++)
        if (strncmp(*variable, "RETEX_PROGRESS=", 15) != 0 && (!temporary || strncmp(*variable, "TMPDIR=", 7) != 0))
            variables[count++] = *variable;
    variables[count++] = (char *)"RETEX_PROGRESS=json";
    if (temporary)
        variables[count++] = temporary;
    variables[count] = NULL;
}

/* In the new process: nothing here may take a lock, or memory. */
static _Noreturn void become(const ChildParams *params, const Pipes *pipes, char *const *variables, pid_t parent)
{
    sigset_t none;
    sigemptyset(&none);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) /* which has ended before this call */
        _exit(NOT_STARTED);
    for (int i = 0; i < 3; i++)
        if (dup2(pipes->ends[i][i > 0], i) < 0)
            _exit(NOT_STARTED);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
    setpriority(PRIO_PROCESS, 0, params->nice);
    if (params->writes)
        (void)confine_writes_to(params->writes_folder);
    if (chdir(params->folder) == 0)
        execve(params->words[0], params->words, variables);
    static const char why[] = "retex-studio: error: the program cannot be started\n";
    (void)!write(STDERR_FILENO, why, sizeof why - 1);
    _exit(NOT_STARTED);
}

int child_start(Child *child, const ChildParams *params, RetexError *err)
{
    Pipes pipes;
    char *variables[MOST_VARIABLES], temporary[4200] = "TMPDIR=";
    int code = open_pipes(&pipes, params->is_fed, err);
    if (code)
        return code;
    if (params->writes)
        strncat(temporary, params->writes, sizeof temporary - 8);
    make_environment(variables, params->writes ? temporary : NULL);
    const pid_t parent = getpid(), pid = fork();
    if (pid == 0)
        become(params, &pipes, variables, parent);
    if (pid < 0) {
        close_pipes(&pipes);
        return retex_fail(err, RETEX_EIO, "cannot start a program: %s", strerror(errno));
    }
    setpgid(pid, pid); /* so that it is so for either of both, whoever is first */
    *child = (Child){pid, pipes.ends[0][1], pipes.ends[1][0], pipes.ends[2][0]};
    pipes.ends[0][1] = pipes.ends[1][0] = pipes.ends[2][0] = -1;
    close_pipes(&pipes);
    fcntl(child->output, F_SETPIPE_SZ, PIPE_BYTES);
    for (const int *file = &child->input; file <= &child->message; file++)
        if (*file >= 0)
            fcntl(*file, F_SETFL, O_NONBLOCK);
    return RETEX_OK;
}

void child_signal(const Child *child, int number)
{
    if (child->pid > 0)
        kill(-child->pid, number);
}

int child_reap(Child *child, int *status, uint64_t *memory)
{
    struct rusage used;
    if (child->pid <= 0)
        return 0;
    const pid_t ended = wait4(child->pid, status, WNOHANG, &used);
    if (ended == 0 || (ended < 0 && errno == EINTR))
        return 0;
    kill(-child->pid, SIGKILL); /* what it may have left */
    *memory = (uint64_t)used.ru_maxrss << 10;
    child->pid = 0;
    return 1;
}

void child_close(Child *child)
{
    child_close_file(&child->input);
    child_close_file(&child->output);
    child_close_file(&child->message);
}
