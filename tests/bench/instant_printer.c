/* bench-side printer that answers at once: `instant-printer LINK` makes a pseudo terminal, names it
 * LINK and answers every line with an ok, numbered or not, until SIGTERM. Then it says what came:
 * moves (lines with a G1), when the first and the last of them, and its own CPU time, so that a
 * host's lines a second are told by somebody else. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

typedef struct tally {
    int64_t lines, moves, bytes;
    double first, last; /* s, of a move */
} tally;

enum { LINE_MOST = 512 };

static volatile sig_atomic_t ending;

static void end(int signal) {
    ending = signal;
}

static double clock_read(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* What an M115, an M105 and an M118 have to be told; everything else is content with an ok. `room`
 * has place for a line of the host's. */
static const char *answer_to(const char *line, size_t length, char *room) {
    const char *command = memchr(line, 'M', length);
    if (!command)
        return "ok\n";
    length -= (size_t)(command - line);
    int number = atoi(command + 1);
    if (number == 115)
        return "FIRMWARE_NAME:Marlin 2.1.2 (bench) SOURCE_CODE_URL:- PROTOCOL_VERSION:1.0 "
               "MACHINE_TYPE:Bench EXTRUDER_COUNT:1 UUID:0\nCap:EMERGENCY_PARSER:1\n"
               "Cap:AUTOREPORT_TEMP:1\nok\n";
    if (number == 105)
        return "ok T:20.00 /0.00 B:20.00 /0.00 @:0 B@:0\n";
    const char *text = memchr(command, ' ', length), *end = memchr(command, '*', length);
    if (number != 118 || !text || !end || end <= text)
        return "ok\n";
    snprintf(room, LINE_MOST, "%.*s\nok\n", (int)(end - text - 1), text + 1);
    return room;
}

static void write_all(int file, const char *bytes, size_t size) {
    while (size > 0 && !ending) {
        ssize_t put = write(file, bytes, size);
        if (put > 0) {
            bytes += put;
            size -= (size_t)put;
        } else if (errno == EAGAIN) {
            poll(&(struct pollfd){file, POLLOUT, 0}, 1, 100);
        } else {
            return; /* the host is gone; what it had still to hear is of no use */
        }
    }
}

/* Answer the whole lines of `bytes`; returns how many bytes they are. */
static size_t answer(int master, tally *seen, const char *bytes, size_t size) {
    static char answers[65536];
    size_t at = 0, held = 0;
    for (const char *stop; (stop = memchr(bytes + at, '\n', size - at));) {
        size_t length = (size_t)(stop - bytes) - at;
        char room[LINE_MOST];
        const char *text = answer_to(bytes + at, length, room);
        seen->lines++;
        if (memmem(bytes + at, length, "G1 ", 3)) {
            seen->last = clock_read(CLOCK_MONOTONIC);
            if (seen->moves++ == 0)
                seen->first = seen->last;
        }
        if (held + strlen(text) > sizeof answers) {
            write_all(master, answers, held);
            held = 0;
        }
        memcpy(answers + held, text, strlen(text));
        held += strlen(text);
        at += length + 1;
    }
    write_all(master, answers, held);
    return at;
}

static void serve(int master, tally *seen) {
    static char buffer[65536];
    size_t held = 0;
    while (!ending) {
        ssize_t got = read(master, buffer + held, sizeof buffer - held);
        if (got > 0) {
            seen->bytes += got;
            held += (size_t)got;
            size_t done = answer(master, seen, buffer, held);
            held -= done;
            memmove(buffer, buffer + done, held);
            held = held == sizeof buffer ? 0 : held;
        } else if (got < 0 && errno == EIO) { /* nobody has it open */
            held = 0;
            poll(NULL, 0, 5);
        }
    }
}

int main(int argc, char **argv) {
    struct termios raw;
    int master = posix_openpt(O_RDWR | O_NOCTTY);
    if (argc != 2 || master < 0 || grantpt(master) || unlockpt(master) || tcgetattr(master, &raw)) {
        fprintf(stderr, "usage: instant-printer LINK\n");
        return 2;
    }
    cfmakeraw(&raw);
    tcsetattr(master, TCSANOW, &raw);
    sigaction(SIGTERM, &(struct sigaction){.sa_handler = end}, NULL);
    unlink(argv[1]);
    if (symlink(ptsname(master), argv[1])) {
        perror(argv[1]);
        return 7;
    }
    tally seen = {0};
    serve(master, &seen);
    unlink(argv[1]);
    printf(
        "{\"lines\": %lld, \"moves\": %lld, \"bytes\": %lld, \"seconds\": %.6f, \"cpu\": %.6f}\n",
        (long long)seen.lines, (long long)seen.moves, (long long)seen.bytes, seen.last - seen.first,
        clock_read(CLOCK_PROCESS_CPUTIME_ID));
    return 0;
}
