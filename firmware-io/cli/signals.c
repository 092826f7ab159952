#include "signals.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <unistd.h>

#include "terminal.h"

static int ends[2] = {-1, -1};

/* Only what POSIX allows in a handler. A full pipe loses signals that say nothing new. */
static void on_signal(int number) {
    int before = errno;
    unsigned char byte = (unsigned char)number;
    ssize_t written = write(ends[1], &byte, 1);
    (void)written;
    errno = before;
}

static void on_defect(int number) {
    fio_terminal_restore();
    raise(number); /* SA_RESETHAND: as if it had never been caught */
}

static bool catch_it(int number, void (*handler)(int), int flags, bool even_if_ignored) {
    struct sigaction action = {.sa_handler = handler, .sa_flags = flags}, before;
    if (sigaction(number, NULL, &before) != 0)
        return false;
    if (before.sa_handler == SIG_IGN && !even_if_ignored)
        return true;
    sigemptyset(&action.sa_mask);
    return sigaction(number, &action, NULL) == 0;
}

fio_status fio_signals_catch(void) {
    static const int told[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGCONT, SIGWINCH};
    static const int ignored[] = {SIGPIPE, SIGTTIN, SIGTTOU, SIGXFSZ}; /* calls fail instead */
    static const int defects[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    bool good = pipe(ends) == 0;
    for (int i = 0; i < 2 && good; i++)
        good = fcntl(ends[i], F_SETFL, O_NONBLOCK) == 0 && fcntl(ends[i], F_SETFD, FD_CLOEXEC) == 0;
    for (size_t i = 0; i < sizeof told / sizeof *told && good; i++)
        good = catch_it(told[i], on_signal, 0, told[i] == SIGTERM);
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored && good; i++)
        good = catch_it(ignored[i], SIG_IGN, 0, true);
    for (size_t i = 0; i < sizeof defects / sizeof *defects && good; i++) {
        struct sigaction before; /* a sanitizer's own report comes first */
        if (sigaction(defects[i], NULL, &before) == 0 && before.sa_handler == SIG_DFL)
            good = catch_it(defects[i], on_defect, (int)SA_RESETHAND, false);
    }
    return good ? FIO_OK : fio_fail(FIO_BUG, "signals can't be caught: %s", strerror(errno));
}

int fio_signals_descriptor(void) {
    return ends[0];
}

int fio_signals_next(void) {
    unsigned char byte;
    return read(ends[0], &byte, 1) == 1 ? byte : 0;
}

void fio_signals_stop(void) {
    fio_terminal_restore();
    raise(SIGSTOP);
}

fio_status fio_signals_check(void) {
    for (int number; (number = fio_signals_next()) != 0;) {
        if (number == SIGINT || number == SIGTERM || number == SIGHUP || number == SIGQUIT)
            return fio_fail(FIO_CANCELLED, "stopped before anything was sent");
        if (number == SIGTSTP)
            fio_signals_stop();
        else if (number == SIGCONT)
            fio_terminal_continue();
    }
    return FIO_OK;
}
