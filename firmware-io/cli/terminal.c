#include "terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

static struct {
    int descriptor;
    volatile bool raw;
    struct termios before;
    unsigned char keys[64];
    int first, count;
} terminal = {.descriptor = -1};

/* In the background, reading or setting the terminal is not ours to do. */
static bool in_foreground(int descriptor) {
    return tcgetpgrp(descriptor) == getpgrp();
}

static void make_raw(void) {
    struct termios wanted;
    if (terminal.raw || terminal.descriptor < 0 || !in_foreground(terminal.descriptor) ||
        tcgetattr(terminal.descriptor, &terminal.before) != 0)
        return;
    wanted = terminal.before;
    wanted.c_lflag &= ~(tcflag_t)(ICANON | ECHO); /* ISIG stays: Ctrl-C is a signal */
    wanted.c_cc[VMIN] = 0;
    wanted.c_cc[VTIME] = 0;
    terminal.raw = tcsetattr(terminal.descriptor, TCSANOW, &wanted) == 0;
}

void fio_terminal_restore(void) {
    if (terminal.raw && in_foreground(terminal.descriptor))
        tcsetattr(terminal.descriptor, TCSANOW, &terminal.before);
    terminal.raw = false;
}

/* After a stop the shell may have set it otherwise: what it is now counts as "before", unless it
 * still is as we left it. */
void fio_terminal_continue(void) {
    struct termios now;
    if (terminal.raw && tcgetattr(terminal.descriptor, &now) == 0 && (now.c_lflag & ICANON))
        terminal.raw = false;
    make_raw();
}

void fio_terminal_keys(bool even_so) {
    if (isatty(STDIN_FILENO))
        terminal.descriptor = STDIN_FILENO;
    else if (even_so && isatty(STDERR_FILENO))
        terminal.descriptor = open("/dev/tty", O_RDONLY | O_NOCTTY | O_CLOEXEC);
    if (terminal.descriptor < 0)
        return;
    atexit(fio_terminal_restore);
    make_raw();
}

int fio_terminal_descriptor(void) {
    return terminal.raw ? terminal.descriptor : -1;
}

/* Take the sequences of arrows and the like out: ESC [ … letter, ESC O letter. Each comes in one
 * read, so that what is cut off spoils no later key. */
static int without_sequences(unsigned char *keys, int count) {
    int kept = 0;
    for (int i = 0; i < count; i++) {
        if (keys[i] != 27) {
            keys[kept++] = keys[i];
        } else if (i + 1 < count && (keys[i + 1] == '[' || keys[i + 1] == 'O')) {
            for (i += 2; i < count && keys[i] < '@';)
                i++;
        }
    }
    return kept;
}

static void read_keys(void) {
    struct pollfd poll_it = {terminal.descriptor, POLLIN, 0};
    terminal.first = terminal.count = 0;
    if (!terminal.raw || poll(&poll_it, 1, 0) != 1)
        return;
    ssize_t got = read(terminal.descriptor, terminal.keys, sizeof terminal.keys);
    if (got <= 0) { /* hung up, or taken by somebody else */
        terminal.raw = false;
        terminal.descriptor = -1;
        return;
    }
    terminal.count = without_sequences(terminal.keys, (int)got);
}

int fio_terminal_key(void) {
    if (terminal.first == terminal.count)
        read_keys();
    return terminal.first < terminal.count ? terminal.keys[terminal.first++] : 0;
}

int fio_terminal_columns(int descriptor) {
    struct winsize size;
    return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool fio_terminal_confirm(const char *question) {
    char answer[16] = "";
    if (!isatty(STDIN_FILENO) || !isatty(STDERR_FILENO) || !in_foreground(STDIN_FILENO))
        return false;
    fprintf(stderr, "%s [y/N] ", question);
    ssize_t got = read(STDIN_FILENO, answer, sizeof answer - 1);
    return got > 0 && (answer[0] == 'y' || answer[0] == 'Y');
}
