#include "transport/tty.h"

#include "base/memory.h"
#include "transport/descriptor.h"
#include "transport/holder.h"

/* Arbitrary rates need the kernel's own struct termios2, which can't be had together with
 * <termios.h>: so this file does without the latter. */
#include <asm/termbits.h>
#include <errno.h>
#include <fcntl.h>
#include <grp.h>
#include <linux/serial.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct tty {
    fio_descriptor base; /* comes first */
    struct termios2 before;
    bool keep_lines;
    bool hurried; /* it was slow to hand bytes over before */
} tty;

static fio_status tty_set_rate(fio_transport *transport, int64_t rate) {
    fio_descriptor *self = (fio_descriptor *)transport;
    struct termios2 settings;
    if (self->lost)
        return fio_descriptor_lose(self, "lost");
    if (rate < 50 || rate > 20000000)
        return fio_fail(FIO_USAGE, "%s: no serial port runs at %lld bits/s", self->name,
                        (long long)rate);
    if (ioctl(self->file, TCGETS2, &settings) < 0)
        return fio_descriptor_lose(self, "the port was unplugged or hung up");
    settings.c_cflag &= ~(tcflag_t)(CBAUD | (CBAUD << IBSHIFT));
    settings.c_cflag |= BOTHER | (BOTHER << IBSHIFT);
    settings.c_ospeed = settings.c_ispeed = (speed_t)rate;
    int failed = ioctl(self->file, TCSETS2, &settings);
    if (failed < 0 && errno == EIO)
        return fio_descriptor_lose(self, "the port was unplugged or hung up");
    if (failed < 0 || ioctl(self->file, TCGETS2, &settings) < 0)
        return fio_fail(FIO_USAGE, "%s: can't be set to %lld bits/s: %s", self->name,
                        (long long)rate, strerror(errno));
    /* Ten bits of 3 % each are a third of a bit off at the last: beyond that bytes go wrong. */
    double ratio = (double)settings.c_ospeed / (double)rate;
    if (ratio < 0.97 || ratio > 1.03)
        return fio_fail(FIO_USAGE, "%s: can't run at %lld bits/s; the nearest is %u", self->name,
                        (long long)rate, settings.c_ospeed);
    self->drain = FIO_DESCRIPTOR_HELD / 2 * 10 / (double)rate;
    return FIO_OK;
}

static fio_status tty_set_lines(fio_transport *transport, bool dtr, bool rts) {
    fio_descriptor *self = (fio_descriptor *)transport;
    int lines;
    if (self->lost)
        return fio_descriptor_lose(self, "lost");
    if (ioctl(self->file, TIOCMGET, &lines) < 0)
        return FIO_OK; /* a pseudo terminal has none; a lost port tells it at the next read */
    lines = (lines & ~(TIOCM_DTR | TIOCM_RTS)) | (dtr ? TIOCM_DTR : 0) | (rts ? TIOCM_RTS : 0);
    if (ioctl(self->file, TIOCMSET, &lines) < 0 && errno == EIO)
        return fio_descriptor_lose(self, "the port was unplugged or hung up");
    return FIO_OK;
}

static fio_status tty_discard(fio_transport *transport, size_t *kept) {
    fio_descriptor *self = (fio_descriptor *)transport;
    *kept = 0;
    if (self->lost)
        return fio_descriptor_lose(self, "lost");
    /* Flushing a pseudo terminal takes back even what had counted as sent. */
    if (fio_descriptor_pending(transport) == 0)
        return FIO_OK;
    if (ioctl(self->file, TCFLSH, TCOFLUSH) < 0 && errno == EIO)
        return fio_descriptor_lose(self, "the port was unplugged or hung up");
    *kept = fio_descriptor_pending(transport); /* of drivers that can't flush */
    return FIO_OK;
}

/* Linux lets an FTDI keep answers for 16 ms, unless it is told to hurry; *was: so far. False where
 * there is no such setting. */
static bool set_hurry(int file, bool hurry, bool *was) {
    struct serial_struct serial;
    if (ioctl(file, TIOCGSERIAL, &serial) < 0)
        return false;
    *was = (serial.flags & ASYNC_LOW_LATENCY) != 0;
    int others = serial.flags & ~(int)ASYNC_LOW_LATENCY;
    serial.flags = hurry ? others | (int)ASYNC_LOW_LATENCY : others;
    return *was == hurry || ioctl(file, TIOCSSERIAL, &serial) == 0;
}

static void tty_close(fio_transport *transport) {
    tty *self = (tty *)transport;
    /* close() would wait half a minute for a device that takes nothing. */
    fio_descriptor_drain(&self->base, 0.5);
    if (fio_descriptor_pending(transport) > 0)
        ioctl(self->base.file, TCFLSH, TCOFLUSH);
    bool was;
    if (self->hurried)
        set_hurry(self->base.file, false, &was);
    if (self->keep_lines)
        self->before.c_cflag &= ~(tcflag_t)HUPCL;
    ioctl(self->base.file, TCSETS2, &self->before);
    ioctl(self->base.file, TIOCNXCL);
    close(self->base.file);
    fio_release(self);
}

static const fio_transport_type tty_type = {
    .name = "tty",
    .read = fio_descriptor_read,
    .write = fio_descriptor_write,
    .pending = fio_descriptor_pending,
    .discard = tty_discard,
    .wait = fio_descriptor_wait,
    .now = fio_descriptor_now,
    .set_rate = tty_set_rate,
    .set_lines = tty_set_lines,
    .close = tty_close,
};

void fio_tty_explain(char *text, size_t capacity, const char *path, int error) {
    char holder[160];
    struct stat node;
    switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
        snprintf(text, capacity, "%s: there is no such port; is the printer plugged in and on?",
                 path);
        return;
    case EACCES:
    case EPERM: {
        const struct group *group = stat(path, &node) == 0 ? getgrgid(node.st_gid) : NULL;
        if (group && group->gr_gid != 0 && node.st_mode & S_IWGRP)
            snprintf(text, capacity,
                     "%s: not allowed; its group is %s: run \"sudo adduser $USER %s\", log out "
                     "and in again",
                     path, group->gr_name, group->gr_name);
        else
            snprintf(text, capacity, "%s: not allowed; install isoslice's udev rules", path);
        return;
    }
    case EBUSY:
    case EWOULDBLOCK:
        if (fio_holder_find(holder, sizeof holder, path))
            snprintf(text, capacity, "%s: in use by %s; end that first", path, holder);
        else
            snprintf(text, capacity,
                     "%s: in use by another program (OctoPrint, ModemManager, …); end that first",
                     path);
        return;
    default:
        snprintf(text, capacity, "%s: %s", path, strerror(error));
    }
}

static fio_status refuse(const char *path, int error) {
    char why[400];
    fio_tty_explain(why, sizeof why, path, error);
    return fio_fail(FIO_NO_PRINTER, "%s", why);
}

/* The descriptor, ours alone; or -1 and errno. */
static int open_alone(const char *path) {
    int file = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return -1;
    /* The one keeps other programs from opening it, the other those that may open all the same. */
    if (flock(file, LOCK_EX | LOCK_NB) < 0 || ioctl(file, TIOCEXCL) < 0) {
        int error = errno;
        close(file);
        errno = error;
        return -1;
    }
    return file;
}

static fio_status set_raw(tty *self) {
    struct termios2 raw = self->before;
    raw.c_iflag = IGNBRK;
    raw.c_oflag = 0;
    raw.c_lflag = 0;
    raw.c_cflag &= ~(tcflag_t)(CSIZE | CSTOPB | PARENB | CRTSCTS);
    raw.c_cflag |= CS8 | CREAD | CLOCAL;
    if (self->keep_lines)
        raw.c_cflag &= ~(tcflag_t)HUPCL;
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    if (ioctl(self->base.file, TCSETS2, &raw) < 0)
        return fio_fail(FIO_NO_PRINTER, "%s: can't be set up: %s", self->base.name,
                        strerror(errno));
    return FIO_OK;
}

fio_status fio_tty_open(fio_transport **transport, const char *path, int64_t rate,
                        bool keep_lines) {
    *transport = NULL;
    int file = open_alone(path);
    if (file < 0 && errno == ENOTTY)
        return fio_fail(FIO_NO_PRINTER, "%s: not a serial port", path);
    if (file < 0)
        return refuse(path, errno);
    tty *self = fio_allocate(sizeof *self);
    if (!self || ioctl(file, TCGETS2, &self->before) < 0) {
        fio_status status = self ? fio_fail(FIO_NO_PRINTER, "%s: not a serial port", path)
                                 : fio_fail(FIO_NO_MEMORY, "no memory for a port");
        fio_release(self);
        close(file);
        return status;
    }
    self->base = (fio_descriptor){
        .transport.type = &tty_type, .file = file, .question = TIOCOUTQ, .counted = true};
    self->keep_lines = keep_lines;
    snprintf(self->base.name, sizeof self->base.name, "tty:%s", path);
    bool was;
    self->hurried = set_hurry(file, true, &was) && !was;
    fio_status status = set_raw(self);
    if (status == FIO_OK)
        status = tty_set_rate(&self->base.transport, rate);
    if (status == FIO_OK && !keep_lines)
        status = tty_set_lines(&self->base.transport, true, true);
    if (status != FIO_OK) {
        tty_close(&self->base.transport);
        return status == FIO_LINK_LOST ? FIO_NO_PRINTER : status;
    }
    *transport = &self->base.transport;
    return FIO_OK;
}
