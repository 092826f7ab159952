#include "base/text.h"

#include <math.h>
#include <string.h>

fio_text fio_text_in(char *bytes, size_t capacity) {
    bytes[0] = 0;
    return (fio_text){bytes, capacity, 0};
}

void fio_text_bytes(fio_text *text, const char *bytes, size_t length) {
    size_t room = text->capacity - 1 - text->length;
    size_t taken = length < room ? length : room;
    memcpy(text->bytes + text->length, bytes, taken);
    text->length += taken;
    text->bytes[text->length] = 0;
}

void fio_text_string(fio_text *text, const char *string) {
    fio_text_bytes(text, string, strlen(string));
}

void fio_text_integer(fio_text *text, int64_t value) {
    char digits[24];
    size_t at = sizeof digits;
    uint64_t rest = value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
    do
        digits[--at] = (char)('0' + rest % 10);
    while (rest /= 10);
    if (value < 0)
        digits[--at] = '-';
    fio_text_bytes(text, digits + at, sizeof digits - at);
}

void fio_text_number(fio_text *text, double value, int decimals) {
    double limit = 9e8;
    if (!(value >= -limit))
        value = value < 0 ? -limit : 0; /* NaN becomes 0 */
    if (value > limit)
        value = limit;
    int64_t scale = 1;
    for (int i = 0; i < decimals; i++)
        scale *= 10;
    int64_t fixed = llround(value * (double)scale);
    int64_t magnitude = fixed < 0 ? -fixed : fixed;
    if (fixed < 0)
        fio_text_bytes(text, "-", 1);
    fio_text_integer(text, magnitude / scale);
    if (decimals == 0)
        return;
    char digits[10];
    int64_t rest = magnitude % scale;
    for (int i = decimals; i-- > 0; rest /= 10)
        digits[i] = (char)('0' + rest % 10);
    fio_text_bytes(text, ".", 1);
    fio_text_bytes(text, digits, (size_t)decimals);
}
