/* Signals, and a command that is run beside the printer. */
#ifndef FIO_CLI_VIRTUAL_COMMAND_H
#define FIO_CLI_VIRTUAL_COMMAND_H

#include <signal.h>
#include <stdbool.h>

#include <isoprint/status.h>

typedef struct virtual_command {
    int process; /* 0: none */
    sigset_t mask;
} virtual_command;

/* True, in the handler of a signal, once there is nothing left to serve: the command has ended, or
 * without one, somebody wants the program to end. */
extern volatile sig_atomic_t virtual_command_ended;

/* From now on SIGINT, SIGTERM and SIGCHLD come only where `mask` is in force. */
void virtual_command_prepare(virtual_command *command);

/* Run it with `port` in ISOPRINT_PORT. `denied`: even as root it may not pass by a file's mode.
 * SIGTERM is passed on to it, SIGINT is not: a terminal sends it to both. */
fio_status virtual_command_start(virtual_command *command, char **words, const char *port,
                                 bool denied) FIO_MUST_CHECK;

/* Its exit code, 128 + the signal that ended it; ends it if it still runs. 0 without a command. */
int virtual_command_finish(virtual_command *command);

#endif
