#define _GNU_SOURCE /* posix_openpt() */
#include "standin/standin.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <termios.h>
#include <unistd.h>

#include "base/memory.h"
#include "standin/link.h"
#include "standin/terminal_rate.h"

/* While no host has the terminal open, its master end reports a hang-up at every look, so it is not
 * watched then: inotify tells of the next open. */
typedef struct terminal {
    fio_standin standin;
    fio_link link;
    int master, opens; /* -1 */
    int64_t rate;
    char name[64];
    char alias[192]; /* the symbolic link; "" */
    bool linked;     /* it was made, so it is ours to remove */
} terminal;

/* What a host left behind: its modes, and answers it did not read. */
static void tidy(terminal *pty) {
    int slave = open(pty->name, O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    struct termios modes;
    if (slave < 0)
        return;
    if (tcgetattr(slave, &modes) == 0) {
        cfmakeraw(&modes);
        cfsetspeed(&modes, B115200);
        tcsetattr(slave, TCSANOW, &modes);
    }
    tcflush(slave, TCIFLUSH);
    close(slave);
}

static void drain_opens(const terminal *pty) {
    char bytes[4096];
    while (read(pty->opens, bytes, sizeof bytes) > 0)
        continue;
}

static bool is_open(const terminal *pty) {
    struct pollfd look = {pty->master, POLLIN, 0};
    return pty->master >= 0 && poll(&look, 1, 0) >= 0 &&
           (!(look.revents & POLLHUP) || look.revents & POLLIN);
}

static void host_came(terminal *pty, double now) {
    fio_standin *standin = &pty->standin;
    fio_link_begin(&pty->link, pty->master, false);
    standin->connected = true;
    standin->sessions++;
    pty->rate = 0;
    fio_machine_set_lines(standin->machine, now, true, true); /* opening a terminal raises them */
}

static void host_left(terminal *pty, double now) {
    fio_standin *standin = &pty->standin;
    standin->connected = false;
    pty->link.file = -1;
    fio_machine_set_lines(standin->machine, now, false, false);
    if (pty->master >= 0) {
        tidy(pty);
        drain_opens(pty);
    }
}

/* At every look: what the printer says first may come before the host's first byte. */
static void follow_rate(terminal *pty, double now) {
    int64_t rate = fio_terminal_rate(pty->master);
    if (rate > 0 && rate != pty->rate)
        fio_machine_set_rate(pty->standin.machine, now, rate);
    pty->rate = rate;
}

static void forget(terminal *pty, double now) {
    char bytes[512];
    while (fio_machine_read(pty->standin.machine, now, bytes, sizeof bytes) > 0)
        continue;
}

static fio_status serve(fio_standin *standin, double now, const struct pollfd *polls, int count) {
    terminal *pty = (terminal *)standin;
    bool readable = false;
    for (int i = 0; i < count; i++)
        if (polls[i].fd == pty->master)
            readable = (polls[i].revents & (POLLIN | POLLHUP)) != 0;
        else if (polls[i].revents)
            drain_opens(pty);
    if (!standin->connected && is_open(pty)) {
        host_came(pty, now);
        readable = true;
    }
    if (!standin->connected) {
        forget(pty, now); /* as a serial bridge that nobody reads */
        return FIO_OK;
    }
    follow_rate(pty, now);
    if (fio_link_serve(&pty->link, standin, now, readable))
        return FIO_OK;
    host_left(pty, now);
    if (is_open(pty)) /* the next came while that was tidied up */
        host_came(pty, now);
    return FIO_OK;
}

static int polls_of(fio_standin *standin, struct pollfd *polls, int most) {
    terminal *pty = (terminal *)standin;
    if (pty->master < 0)
        return 0;
    /* A hang-up would be reported again and again to those who wait for nothing. */
    if (standin->connected && fio_link_events(&pty->link) == 0)
        return 0;
    if (standin->connected)
        polls[0] = (struct pollfd){pty->master, fio_link_events(&pty->link), 0};
    else
        polls[0] = (struct pollfd){pty->opens, POLLIN, 0};
    return 1;
}

static double next(const fio_standin *standin) {
    const terminal *pty = (const terminal *)standin;
    return standin->connected ? fio_link_next(&pty->link, standin)
                              : fio_machine_next(standin->machine);
}

static void drop(terminal *pty) {
    if (pty->master >= 0)
        close(pty->master);
    if (pty->opens >= 0)
        close(pty->opens);
    pty->master = pty->opens = -1;
    if (pty->linked)
        unlink(pty->alias);
    pty->linked = false;
}

static fio_status name_it(terminal *pty) {
    if (!pty->alias[0])
        return FIO_OK;
    static const char terminals[] = "/dev/pts/";
    char target[64] = "";
    if (readlink(pty->alias, target, sizeof target - 1) > 0 &&
        strncmp(target, terminals, strlen(terminals)) == 0)
        unlink(pty->alias); /* one that was left over */
    if (symlink(pty->name, pty->alias) != 0)
        return fio_fail(FIO_NOT_WRITTEN, "%s: can't be made a link to %s: %s", pty->alias,
                        pty->name, strerror(errno));
    pty->linked = true;
    return FIO_OK;
}

static fio_status make(terminal *pty) {
    pty->master = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    pty->opens = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (pty->master < 0 || pty->opens < 0 || grantpt(pty->master) != 0 ||
        unlockpt(pty->master) != 0 || ptsname_r(pty->master, pty->name, sizeof pty->name) != 0)
        return fio_fail(FIO_NOT_WRITTEN, "no pseudo terminal to be had: %s", strerror(errno));
    tidy(pty);
    if (inotify_add_watch(pty->opens, pty->name, IN_OPEN) < 0)
        return fio_fail(FIO_NOT_WRITTEN, "%s: can't be watched: %s", pty->name, strerror(errno));
    snprintf(pty->standin.where, sizeof pty->standin.where, "tty:%s",
             pty->alias[0] ? pty->alias : pty->name);
    return name_it(pty);
}

static fio_status plug(fio_standin *standin, bool in) {
    terminal *pty = (terminal *)standin;
    if (in)
        return make(pty);
    drop(pty); /* who has it open sees a hang-up, as of an unplugged adapter */
    if (standin->connected)
        host_left(pty, fio_pace_now(standin->pace));
    return FIO_OK;
}

static void close_it(fio_standin *standin) {
    drop((terminal *)standin);
}

fio_status fio_standin_pty(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                           const char *link) {
    static const fio_standin_type type = {"pty", polls_of, serve, next, plug, close_it};
    *standin = NULL;
    if (link && strlen(link) >= sizeof((terminal *)0)->alias)
        return fio_fail(FIO_USAGE, "%s: a name of this length is too long", link);
    terminal *pty = fio_allocate(sizeof *pty);
    if (!pty)
        return fio_fail(FIO_NO_MEMORY, "no memory for a pseudo terminal");
    fio_standin_begin(&pty->standin, &type, machine, pace);
    snprintf(pty->alias, sizeof pty->alias, "%s", link ? link : "");
    pty->link.file = -1;
    fio_status status = make(pty);
    if (status == FIO_OK)
        *standin = &pty->standin;
    else
        fio_standin_close(&pty->standin);
    return status;
}
