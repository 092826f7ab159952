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

int fio_line_strip(char text[FIO_LINE_MOST + 1], bool *cut, const char *bytes, size_t length) {
    size_t kept = 0;
    const char *end = bytes + length;
    while (end > bytes && (end[-1] == '\n' || end[-1] == '\r'))
        end--;
    for (const char *p = skip_blanks(bytes, end); p < end && *p != ';'; p++) {
        if (*p == '(') {
            const char *close = memchr(p, ')', (size_t)(end - p));
            if (!close)
                break;
            p = close;
            continue;
        }
        if (kept < FIO_LINE_MOST) /* an echo of control bytes could be taken for two answers */
            text[kept] = (unsigned char)*p < ' ' && *p != '\t' ? '?' : *p;
        kept++;
    }
    *cut = kept > FIO_LINE_MOST;
    int left = *cut ? FIO_LINE_MOST : (int)kept;
    while (left > 0 && blank(text[left - 1]))
        left--;
    text[left] = 0;
    return left;
}

/* C's strtol for 32 bits, as on the boards. */
static int64_t read_long(const char *p) {
    while (blank(*p))
        p++;
    bool negative = *p == '-';
    if (*p == '-' || *p == '+')
        p++;
    int64_t value = 0;
    for (; *p >= '0' && *p <= '9'; p++)
        value = value < INT32_MAX ? value * 10 + (*p - '0') : value;
    value = value < INT32_MAX ? value : INT32_MAX;
    return negative ? -value : value;
}

fio_line_verdict fio_line_check(const char *text, int64_t *last, bool lower) {
    if (*text != 'N' && !(lower && *text == 'n'))
        return FIO_LINE_GOOD;
    const char *number_at = text;
    bool resets = strstr(text, "M110") != NULL; /* its second N wins */
    if (resets && strlen(text) > 4 && strchr(text + 4, 'N'))
        number_at = strchr(text + 4, 'N');
    int64_t number = read_long(number_at + 1);
    if (!resets && number != *last + 1)
        return number == *last || number == *last - 1 ? FIO_LINE_REPEATED : FIO_LINE_NUMBER;
    const char *star = strrchr(text, '*');
    if (!star)
        return FIO_LINE_UNCHECKED;
    unsigned sum = 0;
    for (const char *p = text; p < star; p++)
        sum ^= (unsigned char)*p;
    if (read_long(star + 1) != (int64_t)sum)
        return FIO_LINE_CHECKSUM;
    *last = number;
    return FIO_LINE_GOOD;
}

int64_t fio_line_number(const char *text) {
    return read_long(text + 1);
}

const char *fio_line_complaint(fio_line_verdict verdict) {
    return verdict == FIO_LINE_NUMBER     ? "Line Number is not Last Line Number+1"
           : verdict == FIO_LINE_CHECKSUM ? "checksum mismatch"
                                          : "No Checksum with line number";
}

static const char *read_line_number(fio_line *line, const char *p, bool lower) {
    if (*p != 'N' && !(lower && *p == 'n'))
        return p;
    const char *after = skip_blanks(p + 1, p + strlen(p));
    if (*after == '-')
        after++;
    const char *digits = after;
    while (*after >= '0' && *after <= '9')
        after++;
    if (after == digits)
        return p;
    line->has_number = true;
    line->number = read_long(p + 1);
    return after;
}

static bool checksum_follows(const char *p, const char *end) {
    const char *digits = skip_blanks(p, end), *after = digits;
    while (after < end && *after >= '0' && *after <= '9')
        after++;
    return after > digits && skip_blanks(after, end) == end;
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

void fio_line_read(fio_line *line, const char *text, int length, bool lower) {
    line->has_number = false;
    line->number = -1;
    line->seen = line->valued = 0;
    line->stray = -1;
    line->arguments = 0;
    const char *end = text + length, *start = read_line_number(line, text, lower);
    start = skip_blanks(start, end);
    const char *star = strrchr(start, '*');
    if (star && (line->has_number || checksum_follows(star + 1, end)))
        end = star;
    while (end > start && blank(end[-1]))
        end--;
    line->length = (int)(end - start);
    memcpy(line->text, start, (size_t)line->length);
    line->text[line->length] = 0;
    if (lower || (line->text[0] >= 'A' && line->text[0] <= 'Z'))
        read_command(line, line->text, line->text + line->length);
    else
        line->letter = 0;
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
