/* How near a mistyped word is to a known one. */
#ifndef ISO_CONFIG_SPELLING_H
#define ISO_CONFIG_SPELLING_H

#include <stdbool.h>

enum { ISO_SPELLING_MAX = 48 }; /* letters; longer words are as far as can be */

/* The same but for '-' in `given` where `known` has '_'. */
bool iso_same_key(const char *known, const char *given);

/* Letters to be changed, added or dropped; '-' and '_' are the same letter. O(length^2). */
int iso_edit_distance(const char *known, const char *given);

/* Up to how many a word may be meant: one in three, at most three. */
int iso_edit_tolerance(const char *given);

#endif
