#include "virtual_check.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { TEXT_MOST = 255, RESTORING_MOST = 64 };

struct virtual_check {
    FILE *file;
    const char *path, *host_commands;
    char *line; /* getline()'s */
    size_t capacity;
    int64_t number;               /* of the file's line */
    char expected[TEXT_MOST + 1]; /* "" : the file is at its end */
    char executed[TEXT_MOST + 1];
    int64_t matched;
    int restoring; /* lines that may still be a host's that takes up a print again */
    bool differs;
    char result[800];
};

/* Commands that a host sends of itself while it prints, and those by which it brings a printer back
 * to where it was. */
static const char always[] = "M27,M31,M105,M108,M110,M113,M114,M115,M118,M154,M155,M400,M876";
static const char restoring[] = "G0,G1,G4,G20,G21,G28,G90,G91,G92,M17,M18,M82,M83,M84,M104,M106,"
                                "M107,M109,M117,M140,M190,M204,M211,M220,M221,M413,T0,T1,T2,T3";

static bool is_among(const char *list, const char *command) {
    size_t length = strcspn(command, " ");
    while (list && *list) {
        size_t word = strcspn(list, ",");
        if (word == length && strncmp(list, command, word) == 0)
            return true;
        list += word + (list[word] == ',');
    }
    return false;
}

/* Past blanks, and a line number if there is one: then *length is cut at the checksum. */
static size_t after_number(const char *from, size_t *length) {
    size_t at = 0;
    while (at < *length && isspace((unsigned char)from[at]))
        at++;
    if (at + 1 >= *length || from[at] != 'N' || !isdigit((unsigned char)from[at + 1]))
        return at;
    while (++at < *length && isdigit((unsigned char)from[at]))
        continue;
    const char *star = memchr(from + at, '*', *length - at);
    *length = star ? (size_t)(star - from) : *length;
    while (at < *length && isspace((unsigned char)from[at]))
        at++;
    return at;
}

/* The command word without leading zeros, a blank, and the rest without blanks and comments: line
 * number, checksum and spelling are the way's, not the file's. */
static void normalise(char *to, const char *from, size_t length) {
    size_t at = after_number(from, &length), size = 0;
    bool word = at < length && isalpha((unsigned char)from[at]);
    if (word)
        to[size++] = from[at++];
    while (word && at + 1 < length && from[at] == '0' && isdigit((unsigned char)from[at + 1]))
        at++;
    while (word && at < length && (isdigit((unsigned char)from[at]) || from[at] == '.') && size < 8)
        to[size++] = from[at++];
    size_t start = size;
    for (int depth = 0; at < length && from[at] != ';' && size < TEXT_MOST - 1; at++) {
        depth += from[at] == '(';
        if (depth == 0 && !isspace((unsigned char)from[at])) {
            if (size == start && word)
                to[size++] = ' ';
            to[size++] = from[at];
        }
        depth -= from[at] == ')' && depth > 0;
    }
    to[size] = 0;
}

static void next_expected(virtual_check *check) {
    check->expected[0] = 0;
    ssize_t length;
    while (!check->expected[0] &&
           (length = getline(&check->line, &check->capacity, check->file)) >= 0) {
        check->number++;
        normalise(check->expected, check->line, (size_t)length);
    }
}

fio_status virtual_check_open(virtual_check **check, const char *path, const char *host_commands) {
    *check = NULL;
    FILE *file = fopen(path, "re");
    if (!file)
        return fio_fail(FIO_UNREADABLE, "%s: can't be opened: %s", path, strerror(errno));
    virtual_check *made = fio_allocate(sizeof *made);
    if (!made) {
        fclose(file);
        return fio_fail(FIO_NO_MEMORY, "no memory to check what is executed");
    }
    made->file = file;
    made->path = path;
    made->host_commands = host_commands;
    next_expected(made);
    if (!made->expected[0]) {
        virtual_check_close(made);
        return fio_fail(FIO_UNREADABLE, "%s: can't be read, or there is no command in it", path);
    }
    *check = made;
    return FIO_OK;
}

void virtual_check_close(virtual_check *check) {
    if (!check)
        return;
    fclose(check->file);
    free(check->line);
    fio_release(check);
}

/* Texts to a person (M117 and the like), and lines that are too long for a firmware, may be cut. */
static bool is_same(const char *expected, const char *executed) {
    if (strcmp(expected, executed) == 0)
        return true;
    size_t length = strlen(executed);
    bool cut = is_among("M117,M118,M0,M1,M16,M70,M23,M30,M32", expected) || length > 60;
    return cut && length >= 4 && strncmp(expected, executed, length) == 0;
}

static void differ(virtual_check *check, const char *what) {
    check->differs = true;
    if (check->expected[0])
        snprintf(check->result, sizeof check->result, "line %lld '%s': %s%s%s",
                 (long long)check->number, check->expected, what, *check->executed ? " " : "",
                 check->executed);
    else
        snprintf(check->result, sizeof check->result, "the end: %s %s", what, check->executed);
}

void virtual_check_entry(virtual_check *check, const fio_executed *executed) {
    if (check->differs)
        return;
    normalise(check->executed, executed->text, executed->length);
    if (!check->executed[0])
        return;
    if (check->expected[0] && is_same(check->expected, check->executed)) {
        check->matched++;
        next_expected(check);
        return;
    }
    if (is_among(always, check->executed) || is_among(check->host_commands, check->executed))
        return;
    if (check->restoring > 0 && is_among(restoring, check->executed)) {
        check->restoring--;
        return;
    }
    differ(check, "in its place was executed");
}

void virtual_check_interrupted(virtual_check *check) {
    if (check->matched > 0)
        check->restoring = RESTORING_MOST;
}

const char *virtual_check_result(virtual_check *check) {
    check->executed[0] = 0;
    if (!check->differs && check->expected[0])
        differ(check, "was never executed, nor was anything after it");
    return check->differs ? check->result : NULL;
}
