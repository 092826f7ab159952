#define _GNU_SOURCE /* dprintf() */
#include "virtual_command.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

volatile sig_atomic_t virtual_command_ended;
static volatile sig_atomic_t running; /* the process */

static void on_signal(int number) {
    int error = errno;
    if (number == SIGCHLD || !running)
        virtual_command_ended = 1;
    else if (number == SIGTERM)
        kill((pid_t)running, SIGTERM);
    errno = error;
}

void virtual_command_prepare(virtual_command *command) {
    static const int numbers[] = {SIGINT, SIGTERM, SIGCHLD};
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_NOCLDSTOP};
    sigset_t blocked;
    *command = (virtual_command){0};
    sigemptyset(&blocked);
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        sigaction(numbers[i], &action, NULL);
        sigaddset(&blocked, numbers[i]);
    }
    sigprocmask(SIG_BLOCK, &blocked, &command->mask);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        sigdelset(&command->mask, numbers[i]);
    action.sa_handler = SIG_IGN; /* a host that hangs up is no reason to end */
    sigaction(SIGPIPE, &action, NULL);
}

/* In the child. Root opens anything unless it is without these. */
static void give_up_override(void) {
    enum { DAC_OVERRIDE = 1, DAC_READ_SEARCH = 2 };
    prctl(PR_CAPBSET_DROP, DAC_OVERRIDE, 0, 0, 0);
    prctl(PR_CAPBSET_DROP, DAC_READ_SEARCH, 0, 0, 0);
}

fio_status virtual_command_start(virtual_command *command, char **words, const char *port,
                                 bool denied) {
    setenv("ISOPRINT_PORT", port, 1);
    pid_t process = fork();
    if (process < 0)
        return fio_fail(FIO_NOT_WRITTEN, "no process for %s: %s", words[0], strerror(errno));
    if (process == 0) {
        struct sigaction usual = {.sa_handler = SIG_DFL};
        sigaction(SIGPIPE, &usual, NULL);
        sigprocmask(SIG_SETMASK, &command->mask, NULL);
        if (denied)
            give_up_override();
        execvp(words[0], words);
        dprintf(STDERR_FILENO, "isoprint-virtual: %s: can't be run: %s\n", words[0],
                strerror(errno));
        _exit(127);
    }
    command->process = process;
    running = process;
    return FIO_OK;
}

static int code_of(int state) {
    return WIFSIGNALED(state) ? 128 + WTERMSIG(state) : WEXITSTATUS(state);
}

int virtual_command_finish(virtual_command *command) {
    int state = 0;
    if (!command->process)
        return 0;
    const struct timespec moment = {0, 20000000};
    pid_t ended = waitpid(command->process, &state, WNOHANG);
    if (ended == 0)
        kill(command->process, SIGTERM);
    for (int i = 0; i < 250 && ended == 0; i++) {
        nanosleep(&moment, NULL);
        ended = waitpid(command->process, &state, WNOHANG);
    }
    if (ended == 0) {
        kill(command->process, SIGKILL);
        ended = waitpid(command->process, &state, 0);
    }
    running = 0;
    command->process = 0;
    return ended > 0 ? code_of(state) : 0;
}
