/* How Marlin 2.1 reads lines and looks at their numbers, restated from its queue for the tests:
 * independent of both our encoder and our virtual printer. */
#ifndef TESTS_PROTOCOL_MARLIN_H
#define TESTS_PROTOCOL_MARLIN_H

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MARLIN_LINE = 96 }; /* MAX_CMD_SIZE */

typedef struct marlin {
    bool parentheses; /* PAREN_COMMENTS */
    bool last_star;   /* the command ends at the last '*': not Marlin's way, but others' */
    char line[MARLIN_LINE];
    int length;
    enum { PLAIN, SKIP, INSIDE } state;
    bool escaped;
    long last;
    int rejected, dropped;
    /* A command that would be executed now: its number, -1 if it had none, and its text up to the
     * first '*', as the parser cuts it. */
    void (*execute)(void *context, long number, const char *text);
    void *context;
} marlin;

static inline void marlin_execute(marlin *m, long number, const char *text) {
    char command[MARLIN_LINE];
    strcpy(command, text);
    char *p = command;
    if (*p == 'N' && ((p[1] >= '0' && p[1] <= '9') || p[1] == '-')) {
        p += 2;
        while (*p >= '0' && *p <= '9')
            p++;
        while (*p == ' ')
            p++;
    }
    char *star = m->last_star ? strrchr(p, '*') : strchr(p, '*');
    if (star)
        *star = 0;
    size_t length = strlen(p);
    while (length > 0 && p[length - 1] == ' ')
        p[--length] = 0;
    m->execute(m->context, number, p);
}

static inline void marlin_line(marlin *m) {
    const char *command = m->line;
    while (*command == ' ')
        command++;
    if (*command != 'N') {
        if (*command)
            marlin_execute(m, -1, command);
        return;
    }
    const char *number = command;
    bool resets = strstr(command, "M110") != NULL;
    if (resets && strlen(command) > 4 && strchr(command + 4, 'N'))
        number = strchr(command + 4, 'N');
    long n = strtol(number + 1, NULL, 10);
    if (n != m->last + 1 && !resets) {
        bool again = n == m->last || n == m->last - 1;
        m->dropped += again;
        m->rejected += !again;
        return;
    }
    const char *star = strrchr(command, '*');
    unsigned char sum = 0;
    for (const char *p = command; star && p < star; p++)
        sum ^= (unsigned char)*p;
    if (!star || strtol(star + 1, NULL, 10) != sum) {
        m->rejected++;
        return;
    }
    m->last = n;
    marlin_execute(m, n, command);
}

static inline void marlin_byte(marlin *m, char c) {
    if (c == '\n' || c == '\r') {
        m->line[m->length] = 0;
        bool some = m->length > 0;
        m->length = 0;
        m->state = PLAIN;
        m->escaped = false;
        if (some)
            marlin_line(m);
        return;
    }
    if (m->state == SKIP)
        return;
    if (m->state == INSIDE) {
        if (c == ')')
            m->state = PLAIN;
        return;
    }
    if (m->escaped) {
        m->escaped = false;
    } else if (c == '\\') {
        m->escaped = true;
        return;
    } else if (c == ';' || (c == '(' && m->parentheses)) {
        m->state = c == ';' ? SKIP : INSIDE;
        return;
    }
    if (c == 8) {
        m->length -= m->length > 0;
        return;
    }
    m->line[m->length++] = c;
    if (m->length >= MARLIN_LINE - 1)
        m->state = SKIP;
}

static inline void marlin_bytes(marlin *m, const char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++)
        marlin_byte(m, bytes[i]);
}

/* The emergency parser: what it would obey in these bytes, as the command's code; 0. */
static inline int marlin_emergency(const char *bytes, size_t size) {
    int found = 0;
    for (size_t i = 0; i < size;) {
        size_t end = i;
        while (end < size && bytes[end] != '\n' && bytes[end] != '\r')
            end++;
        size_t p = i;
        while (p < end && bytes[p] == ' ')
            p++;
        if (p < end && bytes[p] == 'N')
            for (p++; p < end &&
                      (bytes[p] == ' ' || bytes[p] == '-' || (bytes[p] >= '0' && bytes[p] <= '9'));)
                p++;
        if (p < end && end < size && bytes[p] == 'M') {
            for (p++; p < end && bytes[p] == ' ';)
                p++;
            if (end - p >= 3) {
                char code[4] = {bytes[p], bytes[p + 1], bytes[p + 2], 0};
                int value = atoi(code);
                if (strspn(code, "0123456789") == 3 &&
                    (value == 108 || value == 112 || value == 410 || value == 876))
                    found = value;
            }
        }
        i = end + 1;
    }
    return found;
}

#endif
