#include "console.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void fio_console_open(fio_console *console, const char *const *commands, int count) {
    console->commands = commands;
    console->count = count;
    console->at = 0;
    console->ended = console->refused = console->skipping = console->pending = false;
    console->temperatures = console->reports = false;
    console->error = 0;
    console->first = console->length = 0;
}

bool fio_console_waits(const fio_console *console, struct pollfd *poll) {
    *poll = (struct pollfd){STDIN_FILENO, POLLIN, 0};
    return !console->commands && !console->ended && !console->pending;
}

static void read_more(fio_console *console) {
    struct pollfd poll_it;
    if (!fio_console_waits(console, &poll_it) || poll(&poll_it, 1, 0) != 1)
        return;
    memmove(console->bytes, console->bytes + console->first, console->length);
    console->first = 0;
    if (console->length == sizeof console->bytes) { /* no end in sight: it is no command */
        console->length = 0;
        console->skipping = true;
    }
    ssize_t got = read(STDIN_FILENO, console->bytes + console->length,
                       sizeof console->bytes - console->length);
    if (got > 0)
        console->length += (size_t)got;
    else if (got == 0)
        console->ended = true;
    else if (errno != EAGAIN && errno != EINTR) {
        console->ended = true;
        console->error = errno;
    }
}

/* Comment, blanks and control characters away: what is left is one command or nothing. */
static fio_status take(fio_console *console, const char *text, size_t length) {
    char wire[FIO_WIRE_LINE_MOST + 1];
    const char *comment = memchr(text, ';', length);
    if (comment)
        length = (size_t)(comment - text);
    while (length > 0 && (unsigned char)text[length - 1] <= ' ')
        length--;
    while (length > 0 && (unsigned char)*text <= ' ')
        text++, length--;
    if (length == 0)
        return FIO_OK;
    for (size_t i = 0; i < length; i++)
        if ((unsigned char)text[i] < ' ' && text[i] != '\t')
            return fio_fail(FIO_USAGE, "a line with control characters is no command");
    if (fio_command_traits(text, length) & (FIO_COMMAND_NUMBERS | FIO_COMMAND_SD_WRITE))
        return fio_fail(FIO_USAGE,
                        "%.*s: not by hand: the numbers of the lines are isoprint's, and "
                        "--upload writes to the card",
                        (int)(length < 40 ? length : 40), text);
    if (length >= sizeof console->line || fio_encode_line(wire, 999999, text, length, 95) == 0)
        return fio_fail(FIO_USAGE, "%.*s...: too long, or no command",
                        (int)(length < 40 ? length : 40), text);
    memcpy(console->line, text, length);
    console->line[length] = 0;
    console->pending = true;
    return FIO_OK;
}

/* The next line of standard input into `line`, if there is a whole one. */
static fio_status take_line(fio_console *console, bool *any) {
    const char *text = console->bytes + console->first;
    const char *end = memchr(text, '\n', console->length);
    *any = end != NULL || (console->ended && console->length > 0);
    if (!*any)
        return FIO_OK;
    size_t length = end ? (size_t)(end - text) : console->length;
    size_t used = end ? length + 1 : length;
    console->first += used;
    console->length -= used;
    if (console->skipping) {
        console->skipping = false;
        return fio_fail(FIO_USAGE, "a line too long for a command");
    }
    return take(console, text, length);
}

static fio_status next_line(fio_console *console, bool *any) {
    if (!console->commands) {
        fio_status status = take_line(console, any);
        if (*any || console->ended)
            return status;
        read_more(console);
        return take_line(console, any);
    }
    *any = console->at < console->count;
    if (!*any) {
        console->ended = true;
        return FIO_OK;
    }
    const char *text = console->commands[console->at++];
    return take(console, text, strlen(text));
}

fio_status fio_console_feed(fio_console *console, fio_streamer *streamer, double now) {
    for (bool any = true; any;) {
        if (!console->pending) {
            fio_status status = next_line(console, &any);
            if (status != FIO_OK) {
                console->refused = true;
                return status;
            }
        }
        if (console->pending && fio_streamer_command(streamer, now, console->line) != FIO_OK)
            return FIO_OK; /* later */
        if (console->pending) {
            console->temperatures |= !strncmp(console->line, "M105", 4);
            console->reports |= !strncmp(console->line, "M155", 4);
        }
        console->pending = false;
    }
    if (console->ended && console->length == 0)
        fio_streamer_finish(streamer, now);
    return FIO_OK;
}
