/* What the kinds share inside the library: the table of kinds, words in their maps, and building a
 * link array by array. */
#ifndef ISO_LINK_MULTILINK_H
#define ISO_LINK_MULTILINK_H

#include <isoslice/link.h>

/* The equations are text, and the text is what the validator runs: words in the names of maps,
 * led by a projection or by "g" for the geometry, "1" for the identity, ² ³ ⁴ for powers, and "≠"
 * where two sides must differ everywhere. Kinds that commute have xy = yx for all their maps. */
typedef struct iso_kind_row {
    const char *name;
    int map_least, map_most;
    const char *map[ISO_LINK_MAPS_MAX];
    int projection_count;
    const char *projection[2];
    int commutes;
    const char *equation[8]; /* up to the first NULL */
} iso_kind_row;

const iso_kind_row *iso_kind_get(iso_link_kind kind);

/* Counts, rules and the range of every stored value; `status` is what a failure returns. */
iso_status iso_multilink_check_shape(const iso_multilink *link, iso_status status) ISO_MUST_CHECK;

/* Build a link that owns its arrays: begin, allocate and fill, finish. finish validates and hands
 * over to *out; if that fails, or `status` already was a failure, it releases everything. */
iso_multilink iso_multilink_begin(iso_link_kind kind, int32_t size, int dimension);
int32_t *iso_map_allocate(iso_map *map, int64_t size, int32_t range); /* NULL: out of memory */
double *iso_multilink_allocate_g(iso_multilink *link);
iso_status iso_multilink_finish(iso_multilink *out, iso_multilink *made,
                                iso_status status) ISO_MUST_CHECK;

/* A word of maps, applied from the last to the first, perhaps led by a projection or g. */
enum { ISO_WORD_PLAIN = -1, ISO_WORD_GEOMETRY = -2 };
typedef struct iso_word {
    int length;
    int head; /* number of the projection, or one of the above */
    int8_t map[8];
} iso_word;

/* Parse one word from *text, which is moved behind it. */
iso_status iso_word_parse(iso_word *word, const char **text,
                          const iso_multilink *link) ISO_MUST_CHECK;

/* The word's maps at a; its head is left to the caller. */
static inline int32_t iso_word_at(const iso_word *word, const iso_multilink *link, int32_t a) {
    for (int i = word->length - 1; i >= 0; i--)
        a = iso_map_at(&link->map[word->map[i]], a);
    return a;
}

#endif
