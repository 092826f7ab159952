#include "virtual/line.h"

#include <math.h>
#include <string.h>

#include "base/number.h"

static inline bool blank(char c) {
    return c == ' ' || c == '\t';
}

static inline int letter_index(char c) {
    unsigned index = ((unsigned)(unsigned char)c | 32u) - 'a';
    return index < 26 ? (int)index : -1;
}

static const char *skip_blanks(const char *p, const char *end) {
    while (p < end && blank(*p))
        p++;
    return p;
}

/* Copy what is no comment; `;` ends the line, parentheses enclose. Control bytes become '?', so
 * that an echo of the line can't be taken for two answers. Returns the length before the cut. */
static size_t strip(fio_line *line, const char *bytes, size_t length) {
    size_t kept = 0;
    const char *end = bytes + length;
    for (const char *p = bytes; p < end && *p != ';'; p++) {
        if (*p == '(') {
            const char *close = memchr(p, ')', (size_t)(end - p));
            if (!close)
                break;
            p = close;
            continue;
        }
        if (kept < FIO_LINE_MOST)
            line->text[kept] = (unsigned char)*p < ' ' && *p != '\t' ? '?' : *p;
        kept++;
    }
    return kept;
}

/* Cut "*checksum" off. False if the line is numbered and its checksum is wrong or missing; Marlin
 * does not look at the checksums of other lines. */
static bool check(fio_line *line) {
    const char *star = NULL, *end = line->text + line->length;
    for (const char *p = end; p > line->text && !star;)
        if (*--p == '*')
            star = p;
    if (!star)
        return !line->has_number;
    double given = -1;
    const char *start = skip_blanks(star + 1, end), *after = fio_number_read(&given, start, end);
    line->has_checksum = after > start && skip_blanks(after, end) == end;
    if (!line->has_checksum)
        return !line->has_number;
    unsigned sum = 0;
    for (const char *p = line->text; p < star; p++)
        sum ^= (unsigned char)*p;
    line->length = (int)(star - line->text);
    return !line->has_number || given == (double)sum;
}

static const char *read_line_number(fio_line *line, const char *p, const char *end) {
    if (p >= end || (*p != 'N' && *p != 'n'))
        return p;
    double number = 0;
    const char *start = skip_blanks(p + 1, end), *after = fio_number_read(&number, start, end);
    if (after == start)
        return p;
    line->has_number = true;
    line->number = isinf(number) ? -1 : (int64_t)number;
    return after;
}

static void read_command(fio_line *line, const char *p, const char *end) {
    line->letter = 0;
    line->arguments = (int)(p - line->text);
    int index = p < end ? letter_index(*p) : -1;
    if (index != 'G' - 'A' && index != 'M' - 'A' && index != 'T' - 'A')
        return;
    const char *digits = skip_blanks(p + 1, end), *after = digits;
    int code = 0;
    for (; after < end && *after >= '0' && *after <= '9'; after++)
        code = code < 100000 ? code * 10 + (*after - '0') : code;
    if (after == digits)
        return;
    line->code = code;
    line->subcode = 0;
    if (after < end && *after == '.')
        for (after++; after < end && *after >= '0' && *after <= '9'; after++)
            line->subcode = line->subcode < 1000 ? line->subcode * 10 + (*after - '0') : 1000;
    line->letter = (char)('A' + index);
    line->arguments = (int)(after - line->text);
}

fio_line_kind fio_line_parse(fio_line *line, const char *bytes, size_t length) {
    while (length > 0 && (bytes[length - 1] == '\n' || bytes[length - 1] == '\r'))
        length--;
    while (length > 0 && blank(*bytes))
        bytes++, length--;
    size_t kept = strip(line, bytes, length);
    line->cut = kept > FIO_LINE_MOST;
    line->length = line->cut ? FIO_LINE_MOST : (int)kept;
    while (line->length > 0 && blank(line->text[line->length - 1]))
        line->length--;
    line->has_number = line->has_checksum = false;
    line->number = -1;
    line->seen = line->valued = 0;
    line->stray = -1;
    if (line->length == 0)
        return FIO_LINE_EMPTY;
    const char *start = read_line_number(line, line->text, line->text + line->length);
    if (!check(line))
        return FIO_LINE_DAMAGED;
    const char *end = line->text + line->length;
    start = skip_blanks(start, end);
    line->length = (int)(end - start);
    memmove(line->text, start, (size_t)line->length);
    while (line->length > 0 && blank(line->text[line->length - 1]))
        line->length--;
    line->text[line->length] = 0;
    read_command(line, line->text, line->text + line->length);
    return line->length || line->has_number ? FIO_LINE_COMMAND : FIO_LINE_EMPTY;
}

void fio_line_words(fio_line *line) {
    const char *end = line->text + line->length;
    for (const char *p = line->text + line->arguments; p < end;) {
        if (blank(*p)) {
            p++;
            continue;
        }
        int index = letter_index(*p);
        if (index < 0) {
            if (line->stray < 0)
                line->stray = (unsigned char)*p;
            p++;
            continue;
        }
        line->seen |= 1u << index;
        const char *start = skip_blanks(p + 1, end);
        const char *after = fio_number_read(&line->value[index], start, end);
        if (after > start && isfinite(line->value[index]))
            line->valued |= 1u << index;
        else
            line->valued &= ~(1u << index); /* the last word of a letter wins, valid or not */
        p = after;
    }
}
