/* Ttys, on real pseudo terminals: what the other side reads and the line settings it sees are the
 * kernel's word, not ours. */
#define _GNU_SOURCE

#include "check.h"

#include <isoprint/transport.h>

#include "transport/tty.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

typedef struct line {
    int master, slave; /* the slave stays open, as a program that reads the port would keep it */
    char path[64];
} line;

static line line_open(void) {
    line pair = {.master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)};
    CHECK(pair.master >= 0 && grantpt(pair.master) == 0 && unlockpt(pair.master) == 0);
    CHECK(ptsname_r(pair.master, pair.path, sizeof pair.path) == 0);
    pair.slave = open(pair.path, O_RDWR | O_NOCTTY);
    CHECK(pair.slave >= 0);
    return pair;
}

static void line_close(line *pair) {
    if (pair->master >= 0)
        close(pair->master);
    close(pair->slave);
}

static size_t master_read(const line *pair, char *bytes, size_t capacity) {
    size_t total = 0;
    for (int quiet = 0; quiet < 20 && total < capacity;) {
        struct pollfd ready = {.fd = pair->master, .events = POLLIN};
        ssize_t got = 0;
        if (poll(&ready, 1, 5) > 0)
            got = read(pair->master, bytes + total, capacity - total);
        total += got > 0 ? (size_t)got : 0;
        quiet = got > 0 ? 0 : quiet + 1;
    }
    return total;
}

static fio_transport *opened(const line *pair) {
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_tty_open(&port, pair->path, 250000, false));
    return port;
}

/* Every value of a byte passes both ways: no translation, echo, signal or flow control. */
static void all_bytes_pass(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair);
    unsigned char sent[256], got[300];
    for (int i = 0; i < 256; i++)
        sent[i] = (unsigned char)i;
    size_t count;
    CHECK_EQUAL(FIO_OK, fio_transport_write(port, sent, sizeof sent, &count));
    CHECK_EQUAL(256, count);
    CHECK_EQUAL(256, master_read(&pair, (char *)got, sizeof got));
    CHECK(memcmp(sent, got, 256) == 0);
    CHECK_EQUAL(256, write(pair.master, sent, sizeof sent));
    size_t total = 0;
    for (double end = fio_transport_now(port) + 10; total < 256 && fio_transport_now(port) < end;) {
        CHECK_EQUAL(FIO_OK, fio_transport_wait(port, false, NULL, 0, 1));
        CHECK_EQUAL(FIO_OK, fio_transport_read(port, got + total, sizeof got - total, &count));
        total += count;
    }
    CHECK_EQUAL(256, total);
    CHECK(memcmp(sent, got, 256) == 0);
    CHECK_EQUAL(FIO_OK, fio_transport_read(port, got, sizeof got, &count));
    CHECK_EQUAL(0, count);
    fio_transport_close(port);
    line_close(&pair);
}

/* 250000 and 1 M have no Bnnn constant. */
static void any_rate(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair);
    const int64_t rates[] = {115200, 250000, 1000000, 2000000, 31250};
    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++) {
        CHECK_EQUAL(FIO_OK, port->type->set_rate(port, rates[i]));
        char command[160], told[32] = "";
        snprintf(command, sizeof command, "stty speed <%s 2>/dev/null", pair.path);
        /* stty opens the port anew, which the exclusive mode allows to root alone. */
        FILE *stty = geteuid() == 0 ? popen(command, "r") : NULL;
        if (stty && fgets(told, sizeof told, stty) && atoll(told) > 0)
            CHECK_EQUAL(rates[i], atoll(told));
        if (stty)
            pclose(stty);
    }
    CHECK_EQUAL(FIO_USAGE, port->type->set_rate(port, 0));
    CHECK_EQUAL(FIO_USAGE, port->type->set_rate(port, INT64_C(1) << 40));
    CHECK_EQUAL(FIO_OK, port->type->set_lines(port, true, false)); /* none there: ignored */
    fio_transport_close(port);
    line_close(&pair);
}

static void settings_come_back(void) {
    line pair = line_open();
    struct termios before, during, after;
    CHECK(tcgetattr(pair.slave, &before) == 0);
    before.c_cc[VEOF] = 7;
    CHECK(tcsetattr(pair.slave, TCSANOW, &before) == 0);
    fio_transport *port = opened(&pair);
    CHECK(tcgetattr(pair.slave, &during) == 0);
    CHECK((during.c_lflag & (ICANON | ECHO | ISIG)) == 0);
    CHECK((during.c_iflag & (IXON | IXOFF | ICRNL | INLCR | IGNCR | ISTRIP)) == 0);
    CHECK((during.c_oflag & OPOST) == 0);
    CHECK((during.c_cflag & CLOCAL) && (during.c_cflag & CSIZE) == CS8);
    fio_transport_close(port);
    CHECK(tcgetattr(pair.slave, &after) == 0);
    CHECK_EQUAL(before.c_lflag, after.c_lflag);
    CHECK_EQUAL(before.c_iflag, after.c_iflag);
    CHECK_EQUAL(before.c_oflag, after.c_oflag);
    CHECK_EQUAL(before.c_cflag, after.c_cflag);
    CHECK_EQUAL(7, after.c_cc[VEOF]);
    CHECK_EQUAL(cfgetospeed(&before), cfgetospeed(&after));
    line_close(&pair);
}

static void lines_kept_do_not_fall(void) {
    line pair = line_open();
    struct termios settings;
    CHECK(tcgetattr(pair.slave, &settings) == 0);
    settings.c_cflag |= HUPCL;
    CHECK(tcsetattr(pair.slave, TCSANOW, &settings) == 0);
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_tty_open(&port, pair.path, 115200, true));
    CHECK(tcgetattr(pair.slave, &settings) == 0);
    CHECK_EQUAL(0, settings.c_cflag & HUPCL);
    fio_transport_close(port);
    CHECK(tcgetattr(pair.slave, &settings) == 0);
    CHECK_EQUAL(0, settings.c_cflag & HUPCL);
    line_close(&pair);
}

static void one_at_a_time(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair), *second = NULL;
    CHECK_EQUAL(FIO_NO_PRINTER, fio_tty_open(&second, pair.path, 115200, false));
    CHECK(!second);
    CHECK(strstr(fio_error_message(), "in use") && strstr(fio_error_message(), pair.path));
    int exclusive = 0;
    CHECK(ioctl(pair.slave, TIOCGEXCL, &exclusive) == 0);
    CHECK_EQUAL(1, exclusive != 0);
    fio_transport_close(port);
    CHECK(ioctl(pair.slave, TIOCGEXCL, &exclusive) == 0);
    CHECK_EQUAL(0, exclusive);
    CHECK_EQUAL(FIO_OK, fio_tty_open(&second, pair.path, 115200, false));
    fio_transport_close(second);
    line_close(&pair);
}

/* The message names the process that has the port. */
static void holder_is_named(void) {
    line pair = line_open();
    int ready[2];
    CHECK(pipe(ready) == 0);
    pid_t child = fork();
    if (child == 0) {
        int file = open(pair.path, O_RDWR | O_NOCTTY);
        char byte = file >= 0 && flock(file, LOCK_EX) == 0;
        if (write(ready[1], &byte, 1) == 1)
            pause();
        _exit(0);
    }
    char byte = 0;
    CHECK(read(ready[0], &byte, 1) == 1 && byte == 1);
    fio_transport *port = NULL;
    char process[32];
    snprintf(process, sizeof process, "process %d", (int)child);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_tty_open(&port, pair.path, 115200, false));
    CHECK(strstr(fio_error_message(), process) != NULL);
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    close(ready[0]);
    close(ready[1]);
    line_close(&pair);
}

/* Every call says so, for ever. (What the port had received and nobody read, the kernel drops when
 * it hangs up a terminal.) */
static void hangup_is_a_loss(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair);
    close(pair.master);
    pair.master = -1;
    char bytes[8];
    size_t count;
    for (int i = 0; i < 3; i++) {
        CHECK_EQUAL(FIO_LINK_LOST, fio_transport_read(port, bytes, sizeof bytes, &count));
        CHECK_EQUAL(0, count);
        CHECK(strstr(fio_error_message(), pair.path) != NULL);
        CHECK_EQUAL(FIO_LINK_LOST, fio_transport_write(port, "M105\n", 5, &count));
        CHECK_EQUAL(0, count);
        CHECK_EQUAL(FIO_LINK_LOST, fio_transport_wait(port, true, NULL, 0, 0));
        CHECK_EQUAL(FIO_LINK_LOST, fio_transport_discard(port, &count));
        CHECK_EQUAL(FIO_LINK_LOST, port->type->set_rate(port, 9600));
        CHECK_EQUAL(FIO_LINK_LOST, port->type->set_lines(port, false, false));
        CHECK_EQUAL(0, fio_transport_pending(port));
    }
    fio_transport_close(port);
    line_close(&pair);
}

static void hangup_ends_a_wait(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair);
    pid_t child = fork();
    if (child == 0) /* it holds the master, too, until it ends */
        usleep(50000), _exit(0);
    close(pair.master);
    pair.master = -1;
    fio_status status = FIO_OK;
    double start = fio_transport_now(port);
    char byte;
    size_t count;
    while (status == FIO_OK && fio_transport_now(port) < start + 20) {
        status = fio_transport_wait(port, false, NULL, 0, 20);
        if (status == FIO_OK)
            status = fio_transport_read(port, &byte, 1, &count);
    }
    CHECK_EQUAL(FIO_LINK_LOST, status);
    CHECK(fio_transport_now(port) - start < 15);
    waitpid(child, NULL, 0);
    fio_transport_close(port);
    line_close(&pair);
}

/* Against a side that does not read, writing ends without blocking; nothing is lost. */
static void back_pressure(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair);
    static unsigned char got[1 << 20];
    unsigned char next = 0;
    size_t sent = 0, count = 1;
    for (int i = 0; i < 10000 && count > 0; i++) {
        unsigned char bytes[700];
        for (size_t j = 0; j < sizeof bytes; j++)
            bytes[j] = (unsigned char)(next + j);
        CHECK_EQUAL(FIO_OK, fio_transport_write(port, bytes, sizeof bytes, &count));
        CHECK(count <= 512);
        next = (unsigned char)(next + count);
        sent += count;
    }
    CHECK_EQUAL(0, count);
    double start = fio_transport_now(port);
    CHECK_EQUAL(FIO_OK, fio_transport_wait(port, true, NULL, 0, 0.05));
    CHECK(fio_transport_now(port) - start > 0.04); /* waits, does not spin */
    size_t total = 0;
    for (size_t more = 1; more; total += more)
        more = master_read(&pair, (char *)got + total, sizeof got - total);
    CHECK_EQUAL(sent, total);
    size_t wrong = 0;
    for (size_t i = 0; i < total; i++)
        wrong += got[i] != (unsigned char)i;
    CHECK_EQUAL(0, wrong);
    CHECK_EQUAL(FIO_OK, fio_transport_wait(port, true, NULL, 0, 5));
    CHECK_EQUAL(FIO_OK, fio_transport_write(port, "x", 1, &count));
    CHECK_EQUAL(1, count);
    fio_transport_close(port);
    line_close(&pair);
}

/* What counts as sent is not taken back: a pseudo terminal's flush would do that. */
static void discard_keeps_what_was_sent(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair);
    size_t count, kept = 99;
    char bytes[16];
    CHECK_EQUAL(FIO_OK, fio_transport_write(port, "M105\n", 5, &count));
    CHECK_EQUAL(0, fio_transport_pending(port));
    CHECK_EQUAL(FIO_OK, fio_transport_discard(port, &kept));
    CHECK_EQUAL(0, kept);
    CHECK_EQUAL(5, master_read(&pair, bytes, sizeof bytes));
    fio_transport_close(port);
    line_close(&pair);
}

static void waiting_for_others(void) {
    line pair = line_open();
    fio_transport *port = opened(&pair);
    int keys[2];
    CHECK(pipe(keys) == 0);
    struct pollfd others[2] = {{.fd = keys[0], .events = POLLIN, .revents = 77},
                               {.fd = -1, .events = POLLIN, .revents = 77}};
    CHECK_EQUAL(FIO_OK, fio_transport_wait(port, false, others, 2, 0.01));
    CHECK_EQUAL(0, others[0].revents);
    CHECK_EQUAL(0, others[1].revents);
    CHECK_EQUAL(1, write(keys[1], "q", 1));
    CHECK_EQUAL(FIO_OK, fio_transport_wait(port, false, others, 2, 30));
    CHECK_EQUAL(POLLIN, others[0].revents);
    double start = fio_transport_now(port);
    CHECK_EQUAL(FIO_OK, fio_transport_wait(port, false, NULL, 0, 0.03));
    CHECK(fio_transport_now(port) - start >= 0.0299);
    CHECK_EQUAL(FIO_OK, fio_transport_wait(port, false, NULL, 0, -1));
    CHECK_EQUAL(FIO_OK, fio_transport_wait(port, true, NULL, 0, INFINITY));
    CHECK_EQUAL(FIO_BUG, fio_transport_wait(port, true, others, 1000, 0));
    close(keys[0]);
    close(keys[1]);
    fio_transport_close(port);
    line_close(&pair);
}

static void what_is_no_port(void) {
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_NO_PRINTER, fio_tty_open(&port, "/dev/ttyACM99", 115200, false));
    CHECK(strstr(fio_error_message(), "no such port") != NULL);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_tty_open(&port, "/dev/null", 115200, false));
    CHECK(strstr(fio_error_message(), "not a serial port") != NULL);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_tty_open(&port, "/", 115200, false));
    CHECK(!port);
    char why[300];
    fio_tty_explain(why, sizeof why, "/dev/null", 13 /* EACCES */);
    CHECK(strstr(why, "not allowed") != NULL);
}

int main(void) {
    RUN(all_bytes_pass);
    RUN(any_rate);
    RUN(settings_come_back);
    RUN(lines_kept_do_not_fall);
    RUN(one_at_a_time);
    RUN(holder_is_named);
    RUN(hangup_is_a_loss);
    RUN(hangup_ends_a_wait);
    RUN(back_pressure);
    RUN(discard_keeps_what_was_sent);
    RUN(waiting_for_others);
    RUN(what_is_no_port);
    return check_verdict();
}
