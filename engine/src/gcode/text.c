#include "gcode/text.h"

#include <stdio.h>
#include <string.h>

#include "gcode/number.h"

/* Days since 1970 to a date, in the proleptic Gregorian calendar: years are made to begin in March,
 * so that the leap day is their last. */
static void civil_date(int64_t days, int *year, int *month, int *day) {
    days += 719468; /* since 0000-03-01 */
    int64_t era = (days >= 0 ? days : days - 146096) / 146097;
    int64_t in_era = days - era * 146097;
    int64_t year_of_era = (in_era - in_era / 1460 + in_era / 36524 - in_era / 146096) / 365;
    int64_t in_year = in_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    int64_t m = (5 * in_year + 2) / 153;
    *day = (int)(in_year - (153 * m + 2) / 5 + 1);
    *month = (int)(m < 10 ? m + 3 : m - 9);
    *year = (int)(year_of_era + era * 400 + (*month <= 2));
}

void iso_text_date(char date[ISO_DATE_SIZE], int64_t timestamp) {
    const int64_t last = 253402300799; /* 9999-12-31 at 23:59:59 */
    timestamp = timestamp < 0 ? 0 : timestamp > last ? last : timestamp;
    int64_t days = timestamp / 86400;
    int seconds = (int)(timestamp % 86400), year, month, day;
    civil_date(days, &year, &month, &day);
    snprintf(date, ISO_DATE_SIZE, "%04d-%02d-%02d at %02d:%02d:%02d", year, month, day,
             seconds / 3600, seconds / 60 % 60, seconds % 60);
}

char *iso_text_put_duration(char *to, int64_t seconds) {
    static const struct {
        int64_t seconds;
        char letter;
    } unit[] = {{86400, 'd'}, {3600, 'h'}, {60, 'm'}, {1, 's'}};
    int begun = 0;
    for (int i = 0; i < 4; i++) {
        int64_t n = seconds / unit[i].seconds;
        seconds %= unit[i].seconds;
        if (n == 0 && !begun && i < 3)
            continue;
        if (begun)
            *to++ = ' ';
        to = iso_put_integer(to, n);
        *to++ = unit[i].letter;
        begun = 1;
    }
    return to;
}

int iso_text_has_command(const char *text, const char *command) {
    size_t size = strlen(command);
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += strspn(line, " \t\r\n");
        char after = strncmp(line, command, size) == 0 ? line[size] : '0';
        if (after == '\0' || strchr(" \t\r\n;", after))
            return 1;
    }
    return 0;
}
