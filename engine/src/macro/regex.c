#include "macro/regex.h"

#include <string.h>

enum { BYTE, ANY, SET, FORK, JUMP, BEGIN, END, MATCH };
enum { NESTING = 32, REPEATS = 255 };

typedef struct compiler {
    iso_regex *regex;
    const char *text;
    int32_t length, at, depth;
    const char *wrong;
} compiler;

/* Jumps are relative, so that parts can be moved and copied as they are. */

static void fail(compiler *c, const char *wrong) {
    if (!c->wrong)
        c->wrong = wrong;
}

static int32_t add(compiler *c, int kind, int value, int32_t other) {
    iso_regex *regex = c->regex;
    if (regex->count == ISO_REGEX_STATES) {
        fail(c, "the expression is too long");
        return regex->count - 1;
    }
    regex->state[regex->count] = (iso_regex_state){(uint8_t)kind, (uint8_t)value, (int16_t)other};
    return regex->count++;
}

static void insert_fork(compiler *c, int32_t at, int32_t other) {
    iso_regex *regex = c->regex;
    int32_t count = regex->count - at;
    add(c, FORK, 0, other);
    if (c->wrong)
        return;
    iso_regex_state fork = regex->state[regex->count - 1];
    memmove(&regex->state[at + 1], &regex->state[at], (size_t)count * sizeof fork);
    regex->state[at] = fork;
}

static bool more(const compiler *c) {
    return !c->wrong && c->at < c->length;
}

static char peek(const compiler *c) {
    return c->at < c->length ? c->text[c->at] : 0;
}

/* ---- sets ---- */

static void set_add(uint32_t set[8], int low, int high) {
    for (int b = low; b <= high; b++)
        set[b >> 5] |= 1u << (b & 31);
}

static void set_invert(uint32_t set[8]) {
    for (int i = 0; i < 8; i++)
        set[i] = ~set[i];
}

/* \d \w \s and their opposites; false if the letter is none of them */
static bool set_add_class(uint32_t set[8], char letter) {
    uint32_t class[8] = {0};
    switch (letter | 0x20) {
    case 'd':
        set_add(class, '0', '9');
        break;
    case 'w':
        set_add(class, '0', '9');
        set_add(class, 'a', 'z');
        set_add(class, 'A', 'Z');
        set_add(class, '_', '_');
        break;
    case 's':
        set_add(class, '\t', '\r');
        set_add(class, ' ', ' ');
        break;
    default:
        return false;
    }
    if (!(letter & 0x20))
        set_invert(class);
    for (int i = 0; i < 8; i++)
        set[i] |= class[i];
    return true;
}

/* What a letter behind a backslash stands for; letters that stand for anything else are refused. */
static int escaped(compiler *c, char letter) {
    bool is_letter =
        ((letter | 0x20) >= 'a' && (letter | 0x20) <= 'z') || (letter >= '0' && letter <= '9');
    switch (letter) {
    case 't':
        return '\t';
    case 'n':
        return '\n';
    case 'r':
        return '\r';
    default:
        if (is_letter)
            fail(c, "this escape is not supported in regular expressions");
        return (unsigned char)letter;
    }
}

static uint32_t *new_set(compiler *c) {
    if (c->regex->set_count == ISO_REGEX_SETS) {
        fail(c, "the expression has too many sets");
        return c->regex->set[0];
    }
    uint32_t *set = c->regex->set[c->regex->set_count++];
    memset(set, 0, sizeof c->regex->set[0]);
    return set;
}

/* One end of a range in a set, or a whole class: then -1. */
static int set_member(compiler *c, uint32_t set[8]) {
    char letter = c->text[c->at++];
    if (letter == '[' && (peek(c) == ':' || peek(c) == '.' || peek(c) == '='))
        fail(c, "named sets are not supported in regular expressions");
    if (letter != '\\' || c->at == c->length)
        return (unsigned char)letter;
    letter = c->text[c->at++];
    return set_add_class(set, letter) ? -1 : escaped(c, letter);
}

static void parse_set(compiler *c) {
    uint32_t *set = new_set(c);
    bool inverted = peek(c) == '^', first = true;
    c->at += inverted;
    for (; more(c) && (peek(c) != ']' || first); first = false) {
        int low = set_member(c, set), high = low;
        if (low >= 0 && peek(c) == '-' && c->at + 1 < c->length && c->text[c->at + 1] != ']') {
            c->at++;
            high = set_member(c, set);
            if (high < low)
                fail(c, "the range of a set ends before it begins");
        }
        if (low >= 0)
            set_add(set, low, high);
    }
    if (!more(c))
        fail(c, "expected ] at the end of the set");
    c->at++;
    if (inverted)
        set_invert(set);
    add(c, SET, c->regex->set_count - 1, 0);
}

/* ---- atoms ---- */

static void parse_alternatives(compiler *c);

static void parse_group(compiler *c) {
    if (peek(c) == '?') {
        if (c->at + 1 >= c->length || c->text[c->at + 1] != ':')
            fail(c, "only (?: ) is supported of the groups that begin with (?");
        c->at += 2;
    }
    if (++c->depth > NESTING)
        fail(c, "the groups are too deeply nested");
    if (!c->wrong)
        parse_alternatives(c);
    c->depth--;
    if (!c->wrong && peek(c) != ')')
        fail(c, "expected ) at the end of the group");
    c->at++;
}

static void parse_escape(compiler *c) {
    if (!more(c)) {
        fail(c, "expected a letter behind the \\");
        return;
    }
    uint32_t class[8] = {0};
    char letter = c->text[c->at++];
    if (!set_add_class(class, letter)) {
        add(c, BYTE, escaped(c, letter), 0);
        return;
    }
    memcpy(new_set(c), class, sizeof class);
    add(c, SET, c->regex->set_count - 1, 0);
}

static void parse_atom(compiler *c) {
    char letter = c->text[c->at++];
    switch (letter) {
    case '(':
        parse_group(c);
        break;
    case '[':
        parse_set(c);
        break;
    case '\\':
        parse_escape(c);
        break;
    case '.':
        add(c, ANY, 0, 0);
        break;
    case '^':
        add(c, BEGIN, 0, 0);
        break;
    case '$':
        add(c, END, 0, 0);
        break;
    case '*':
    case '+':
    case '?':
    case '{':
        fail(c, "there is nothing to repeat");
        break;
    default:
        add(c, BYTE, (unsigned char)letter, 0);
    }
}

/* ---- repetition ---- */

static int32_t read_count(compiler *c) {
    int32_t count = 0, begin = c->at;
    while (peek(c) >= '0' && peek(c) <= '9' && count <= REPEATS)
        count = 10 * count + (c->text[c->at++] - '0');
    if (c->at == begin || count > REPEATS)
        fail(c, "expected a number from 0 to 255 in { }");
    return count;
}

static void copy_atom(compiler *c, const iso_regex_state *atom, int32_t size) {
    for (int32_t i = 0; i < size; i++)
        add(c, atom[i].kind, atom[i].value, atom[i].other);
}

/* The states from `at` on, `least` to `most` times; most < 0: without an end. */
static void repeat(compiler *c, int32_t at, int32_t least, int32_t most) {
    iso_regex_state atom[ISO_REGEX_STATES];
    int32_t size = c->regex->count - at;
    memcpy(atom, &c->regex->state[at], (size_t)size * sizeof *atom);
    c->regex->count = at;
    for (int32_t i = 0; i < least && !c->wrong; i++)
        copy_atom(c, atom, size);
    if (most < 0) {
        add(c, FORK, 0, size + 2);
        copy_atom(c, atom, size);
        add(c, JUMP, 0, -size - 1);
    }
    for (int32_t i = least; i < most && !c->wrong; i++) {
        add(c, FORK, 0, size + 1);
        copy_atom(c, atom, size);
    }
}

static void parse_repetition(compiler *c, int32_t at) {
    int32_t least = 0, most = -1;
    switch (peek(c)) {
    case '*':
        break;
    case '+':
        least = 1;
        break;
    case '?':
        most = 1;
        break;
    case '{':
        c->at++;
        least = most = read_count(c);
        if (peek(c) == ',') {
            c->at++;
            most = peek(c) == '}' ? -1 : read_count(c);
        }
        if (!c->wrong && (peek(c) != '}' || (most >= 0 && most < least)))
            fail(c, "expected {n}, {n,} or {n,m}");
        break;
    default:
        return;
    }
    c->at++;
    if (peek(c) == '?') /* as few as possible: the same for a whole match */
        c->at++;
    if (!c->wrong)
        repeat(c, at, least, most);
}

/* ---- sequences ---- */

/* A chain of jumps over the alternatives that follow, linked by their own places until the end is
 * known. */
static void parse_alternatives(compiler *c) {
    int32_t last_jump = -1, begin = c->regex->count;
    while (more(c) && peek(c) != ')') {
        if (peek(c) == '|') {
            c->at++;
            insert_fork(c, begin, c->regex->count - begin + 2);
            last_jump = add(c, JUMP, 0, last_jump);
            begin = c->regex->count;
            continue;
        }
        int32_t atom = c->regex->count;
        parse_atom(c);
        parse_repetition(c, atom);
    }
    while (!c->wrong && last_jump >= 0) {
        int32_t before = c->regex->state[last_jump].other;
        c->regex->state[last_jump].other = (int16_t)(c->regex->count - last_jump);
        last_jump = before;
    }
}

const char *iso_regex_compile(iso_regex *regex, const char *text, int32_t length, int32_t *at) {
    compiler c = {.regex = regex, .text = text, .length = length};
    regex->count = regex->set_count = 0;
    regex->any_case = length >= 4 && memcmp(text, "(?i)", 4) == 0;
    c.at = regex->any_case ? 4 : 0;
    parse_alternatives(&c);
    if (more(&c))
        fail(&c, "this ) has no ( before it");
    add(&c, MATCH, 0, 0);
    *at = c.at < length ? c.at : length;
    return c.wrong;
}

/* ---- matching ---- */

typedef struct states {
    int32_t count;
    int16_t list[ISO_REGEX_STATES];
    uint32_t has[ISO_REGEX_STATES / 32];
} states;

/* `state` and all that is reached from it without taking anything; the list is the stack, too. */
static void follow(states *set, const iso_regex *regex, int32_t state, bool first, bool last) {
    int16_t stack[ISO_REGEX_STATES];
    int32_t depth = 0;
    while (true) {
        const iso_regex_state *at = &regex->state[state];
        bool fresh = !(set->has[state >> 5] >> (state & 31) & 1);
        set->has[state >> 5] |= 1u << (state & 31);
        if (fresh && at->kind == FORK)
            stack[depth++] = (int16_t)(state + at->other);
        if (fresh && at->kind <= SET)
            set->list[set->count++] = (int16_t)state;
        if (fresh &&
            (at->kind == FORK || (at->kind == BEGIN && first) || (at->kind == END && last))) {
            state++;
        } else if (fresh && at->kind == JUMP) {
            state += at->other;
        } else if (depth > 0) {
            state = stack[--depth];
        } else {
            return;
        }
    }
}

static unsigned char lower(unsigned char c) {
    return c >= 'A' && c <= 'Z' ? (unsigned char)(c | 0x20) : c;
}

static bool takes(const iso_regex *regex, const iso_regex_state *state, unsigned char c) {
    if (state->kind == ANY)
        return true;
    if (state->kind == BYTE)
        return state->value == c || (regex->any_case && lower(state->value) == lower(c));
    const uint32_t *set = regex->set[state->value];
    unsigned char other = c;
    if (regex->any_case && lower(c) >= 'a' && lower(c) <= 'z')
        other = c ^ 0x20;
    return (set[c >> 5] >> (c & 31) & 1) || (set[other >> 5] >> (other & 31) & 1);
}

bool iso_regex_matches(const iso_regex *regex, const char *text, int32_t length) {
    states set[2], *now = &set[0], *then = &set[1];
    int32_t match = regex->count - 1;
    memset(now, 0, sizeof *now);
    follow(now, regex, 0, true, length == 0);
    for (int32_t i = 0; i < length; i++) {
        if (now->count == 0)
            return false;
        then->count = 0;
        memset(then->has, 0, sizeof then->has);
        for (int32_t k = 0; k < now->count; k++)
            if (takes(regex, &regex->state[now->list[k]], (unsigned char)text[i]))
                follow(then, regex, now->list[k] + 1, false, i + 1 == length);
        states *spare = now;
        now = then;
        then = spare;
    }
    return now->has[match >> 5] >> (match & 31) & 1;
}
