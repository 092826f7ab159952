/* Regular expressions as PrusaSlicer's =~ has them: Perl's, matched against the whole text.
 *
 * Here: literals, . (any character, line ends too), [sets], \d \w \s and their opposites, \t \n \r,
 * groups ( ) and (?: ), |, * + ? {n} {n,} {n,m} (greedy or not: it makes no difference to whether
 * all of it matches), ^ and $ for the ends of the text, and (?i) at the beginning. Not: backward
 * references, looking ahead or back, \b, named sets as [:alpha:].
 *
 * All states are followed at once, so a match takes time in proportion to text and expression. */
#ifndef ISO_MACRO_REGEX_H
#define ISO_MACRO_REGEX_H

#include <stdbool.h>
#include <stdint.h>

#include <isoslice/status.h>

enum { ISO_REGEX_STATES = 1024, ISO_REGEX_SETS = 32 };

/* What a state takes, and where it goes: to the next state, or for a fork also elsewhere. */
typedef struct iso_regex_state {
    uint8_t kind, value;
    int16_t other;
} iso_regex_state;

typedef struct iso_regex {
    int32_t count, set_count;
    iso_regex_state state[ISO_REGEX_STATES];
    uint32_t set[ISO_REGEX_SETS][8]; /* a bit a byte */
    bool any_case;
} iso_regex;

/* NULL, or what is wrong with the expression; *at then is where. */
const char *iso_regex_compile(iso_regex *regex, const char *text, int32_t length, int32_t *at);
bool iso_regex_matches(const iso_regex *regex, const char *text, int32_t length);

#endif
