/* The validator: one interpreter for the equations of all kinds. */
#include "link/multilink.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"

static iso_status check_map(const iso_multilink *link, const iso_map *map, int is_endomap,
                            iso_status status) {
    const char *kind = iso_link_kind_name(link->kind);
    if (memchr(map->name, 0, sizeof map->name) == NULL)
        return iso_fail(status, "%s: the name of a map does not end", kind);
    if (map->range < 0 || (is_endomap && map->range != link->size))
        return iso_fail(status, "%s: the range of %s is %d; %s %d", kind, map->name, map->range,
                        is_endomap ? "an endomap's is the size," : "it is at least",
                        is_endomap ? link->size : 0);
    if (map->rule == ISO_MAP_STORED) {
        if (!map->image && link->size > 0)
            return iso_fail(status, "%s: %s is stored but has no image", kind, map->name);
        for (int32_t a = 0; a < link->size; a++)
            if (map->image[a] < 0 || map->image[a] >= map->range)
                return iso_fail(status, "%s: %s takes index %d to %d, outside 0 .. %d", kind,
                                map->name, a, map->image[a], map->range - 1);
        return ISO_OK;
    }
    int is_step = map->rule == ISO_MAP_CYCLIC || map->rule == ISO_MAP_CLAMPED;
    if (map->image || map->stride < 1 || map->length < 1 ||
        (is_endomap ? !is_step : map->rule != ISO_MAP_COORDINATE))
        return iso_fail(status, "%s: %s has rule %d, stride %d, length %d, which is no %s", kind,
                        map->name, (int)map->rule, map->stride, map->length,
                        is_endomap ? "step along an axis" : "coordinate");
    if (is_endomap && link->size % ((int64_t)map->stride * map->length) != 0)
        return iso_fail(status, "%s: the axis of %s (stride %d, length %d) does not fit size %d",
                        kind, map->name, map->stride, map->length, link->size);
    if (!is_endomap && map->range < map->length)
        return iso_fail(status, "%s: %s has %d places on its axis, more than its range %d", kind,
                        map->name, map->length, map->range);
    return ISO_OK;
}

iso_status iso_multilink_check_shape(const iso_multilink *link, iso_status status) {
    const iso_kind_row *row = iso_kind_get(link->kind);
    if (!row)
        return iso_fail(status, "there is no kind %d of multi-link", (int)link->kind);
    if (link->size < 0)
        return iso_fail(status, "%s: negative size %d", row->name, link->size);
    if (link->map_count < row->map_least || link->map_count > row->map_most)
        return iso_fail(status, "%s: %d maps; it has %d to %d", row->name, link->map_count,
                        row->map_least, row->map_most);
    if (link->projection_count < row->projection_count ||
        link->projection_count > ISO_LINK_MAPS_MAX)
        return iso_fail(status, "%s: %d projections; it has %d to %d", row->name,
                        link->projection_count, row->projection_count, ISO_LINK_MAPS_MAX);
    if (link->dimension < 0 || link->dimension > ISO_LINK_DIMENSION_MAX)
        return iso_fail(status, "%s: dimension %d of g; it is 0 to %d", row->name, link->dimension,
                        ISO_LINK_DIMENSION_MAX);
    if (link->dimension > 0 && link->size > 0 && !link->g)
        return iso_fail(status, "%s: g of dimension %d has no array", row->name, link->dimension);
    for (int i = 0; i < link->map_count; i++)
        ISO_TRY(check_map(link, &link->map[i], 1, status));
    for (int i = 0; i < link->projection_count; i++)
        ISO_TRY(check_map(link, &link->projection[i], 0, status));
    return ISO_OK;
}

static int starts_with(const char *text, const char *name) {
    size_t length = strlen(name);
    return length > 0 && strncmp(text, name, length) == 0 ? (int)length : 0;
}

/* A map's number, or -1. Names of a kind don't begin with one another. */
static int match_map(const char *text, const iso_multilink *link, int *matched) {
    const iso_kind_row *row = iso_kind_get(link->kind);
    for (int i = 0; i < link->map_count && i < row->map_most; i++)
        if ((*matched = starts_with(text, row->map[i])) > 0)
            return i;
    return -1;
}

/* What leads a word: a projection or, where no map has that name, the geometry. */
static int match_head(const char *text, const iso_multilink *link, int *matched) {
    const iso_kind_row *row = iso_kind_get(link->kind);
    if (match_map(text, link, matched) >= 0)
        return *matched = 0, ISO_WORD_PLAIN;
    for (int i = 0; i < row->projection_count; i++)
        if ((*matched = starts_with(text, row->projection[i])) > 0)
            return i;
    *matched = starts_with(text, "g");
    return *matched ? ISO_WORD_GEOMETRY : ISO_WORD_PLAIN;
}

static int match_power(const char *text, int *matched) {
    static const char *const power[] = {"²", "³", "⁴"};
    for (int i = 0; i < 3; i++)
        if ((*matched = starts_with(text, power[i])) > 0)
            return i + 2;
    *matched = 0;
    return 1;
}

iso_status iso_word_parse(iso_word *word, const char **text, const iso_multilink *link) {
    const char *at = *text;
    int matched;
    *word = (iso_word){0};
    while (*at == ' ')
        at++;
    const char *start = at;
    word->head = match_head(at, link, &matched);
    at += matched;
    if (*at == '1' && at == start)
        at++;
    else
        for (int map; (map = match_map(at, link, &matched)) >= 0;) {
            at += matched;
            int power = match_power(at, &matched);
            at += matched;
            for (; power > 0 && word->length < (int)sizeof word->map; power--)
                word->map[word->length++] = (int8_t)map;
            if (power > 0)
                return iso_fail(ISO_USAGE, "the word \"%s\" is too long", *text);
        }
    if (at == start || (*at && *at != ' '))
        return iso_fail(ISO_USAGE, "\"%s\" is no word in the maps of a %s", *text,
                        iso_link_kind_name(link->kind));
    *text = at;
    return ISO_OK;
}

typedef struct iso_equation {
    const char *text;
    iso_word left, right;
    int differs; /* ≠ instead of = */
} iso_equation;

static iso_status parse_equation(iso_equation *equation, const char *text,
                                 const iso_multilink *link) {
    static const char same[] = " = ", differ[] = " ≠ ";
    equation->text = text;
    ISO_TRY(iso_word_parse(&equation->left, &text, link));
    int matched = starts_with(text, same);
    equation->differs = matched == 0;
    text += matched ? matched : starts_with(text, differ);
    return iso_word_parse(&equation->right, &text, link);
}

static iso_status broken(const iso_multilink *link, const iso_equation *equation, int32_t a,
                         int32_t left, int32_t right) {
    return iso_fail(ISO_NOT_VERIFIED, "%s: %s fails at index %d: %d and %d",
                    iso_link_kind_name(link->kind), equation->text, a, left, right);
}

static iso_status check_places(const iso_multilink *link, const iso_equation *equation, int32_t a,
                               int32_t left, int32_t right) {
    int n = link->dimension;
    for (int k = 0; k < n; k++) {
        double x = link->g[(int64_t)left * n + k], y = link->g[(int64_t)right * n + k];
        if (x != y)
            return iso_fail(ISO_NOT_VERIFIED,
                            "%s: %s fails at index %d: coordinate %d is %.17g and %.17g",
                            iso_link_kind_name(link->kind), equation->text, a, k, x, y);
    }
    return ISO_OK;
}

static iso_status check_equation(const iso_multilink *link, const char *text) {
    iso_equation equation;
    iso_status status = parse_equation(&equation, text, link);
    if (status != ISO_OK)
        return iso_fail(ISO_BUG, "the equation \"%s\" can't be read", text);
    int head = equation.left.head;
    const iso_map *projection = head >= 0 ? &link->projection[head] : NULL;
    for (int32_t a = 0; a < link->size; a++) {
        int32_t left = iso_word_at(&equation.left, link, a);
        int32_t right = iso_word_at(&equation.right, link, a);
        if (head == ISO_WORD_GEOMETRY) {
            ISO_TRY(check_places(link, &equation, a, left, right));
            continue;
        }
        if (projection) {
            left = iso_map_at(projection, left);
            right = iso_map_at(projection, right);
        }
        if ((left == right) == equation.differs)
            return broken(link, &equation, a, left, right);
    }
    return ISO_OK;
}

static iso_status check_commuting(const iso_multilink *link, const iso_kind_row *row) {
    for (int i = 0; i < link->map_count; i++)
        for (int j = i + 1; j < link->map_count; j++) {
            const char *x = row->map[i], *y = row->map[j];
            char text[4 * ISO_LINK_NAME_SIZE + 8];
            snprintf(text, sizeof text, "%s%s = %s%s", x, y, y, x);
            ISO_TRY(check_equation(link, text));
        }
    return ISO_OK;
}

static iso_status check_finite(const iso_multilink *link) {
    for (int64_t i = 0; i < (int64_t)link->size * link->dimension; i++)
        if (!isfinite(link->g[i]))
            return iso_fail(ISO_NOT_VERIFIED, "%s: g is not finite at index %d, coordinate %d",
                            iso_link_kind_name(link->kind), (int32_t)(i / link->dimension),
                            (int)(i % link->dimension));
    return ISO_OK;
}

iso_status iso_multilink_validate(const iso_multilink *link) {
    ISO_TRY(iso_multilink_check_shape(link, ISO_NOT_VERIFIED));
    const iso_kind_row *row = iso_kind_get(link->kind);
    ISO_TRY(check_finite(link));
    if (row->commutes)
        ISO_TRY(check_commuting(link, row));
    for (int i = 0; i < 8 && row->equation[i]; i++)
        ISO_TRY(check_equation(link, row->equation[i]));
    return ISO_OK;
}

static iso_status plain_word(iso_word *word, const char **text, const iso_multilink *link) {
    const char *start = *text;
    ISO_TRY(iso_word_parse(word, text, link));
    if (word->head != ISO_WORD_PLAIN)
        return iso_fail(ISO_USAGE, "\"%s\" is led by a projection; orbits need maps alone", start);
    return ISO_OK;
}

iso_status iso_multilink_check_bijective(const iso_multilink *link, const char *text) {
    const char *at = text;
    iso_word word;
    int32_t *origin;
    ISO_TRY(plain_word(&word, &at, link));
    ISO_TRY(ISO_ALLOCATE(origin, link->size));
    for (int32_t a = 0; a < link->size; a++)
        origin[a] = -1;
    iso_status status = ISO_OK;
    for (int32_t a = 0; a < link->size && status == ISO_OK; a++) {
        int32_t image = iso_word_at(&word, link, a);
        if (origin[image] >= 0)
            status = iso_fail(ISO_NOT_VERIFIED, "%s: %s is no bijection: it takes %d and %d to %d",
                              iso_link_kind_name(link->kind), text, origin[image], a, image);
        origin[image] = a;
    }
    iso_release(origin);
    return status;
}

static int32_t find_root(int32_t *parent, int32_t a) {
    while (parent[a] != a)
        a = parent[a] = parent[parent[a]];
    return a;
}

iso_status iso_multilink_orbits(int32_t *orbit, int32_t *count, const iso_multilink *link,
                                const char *words) {
    for (int32_t a = 0; a < link->size; a++)
        orbit[a] = a;
    const char *at = words;
    while (at[strspn(at, " ")]) {
        iso_word word;
        ISO_TRY(plain_word(&word, &at, link));
        for (int32_t a = 0; a < link->size; a++) {
            int32_t x = find_root(orbit, a), y = find_root(orbit, iso_word_at(&word, link, a));
            orbit[x > y ? x : y] = x < y ? x : y;
        }
    }
    /* parents come before their children, so each finds its parent's label in place */
    int32_t labels = 0;
    for (int32_t a = 0; a < link->size; a++)
        orbit[a] = orbit[a] == a ? labels++ : orbit[orbit[a]];
    *count = labels;
    return ISO_OK;
}
