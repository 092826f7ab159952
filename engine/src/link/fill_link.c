#include "link/fill_link.h"

iso_status iso_fill_link_validate(const iso_fill_link *link) {
    int32_t count = link->count;
    if (count < 0 || count % 2)
        return iso_fail(ISO_BUG, "fill link: %d crossings, not an even number", count);
    for (int32_t c = 0; c < count; c++) {
        if (link->line[c] < 0 || link->line[c] >= link->line_count)
            return iso_fail(ISO_BUG, "fill link: q(%d) = %d is no line", c, link->line[c]);
        if (c && link->line[c] < link->line[c - 1])
            return iso_fail(ISO_BUG, "fill link: crossing %d is not in the order of lines", c);
        if (link->line[c] != link->line[c ^ 1])
            return iso_fail(ISO_BUG, "fill link: qF = q fails at crossing %d", c);
        if (link->contour[c] < 0 || link->contour[c] >= link->contour_count)
            return iso_fail(ISO_BUG, "fill link: p(%d) = %d is no contour", c, link->contour[c]);
    }
    for (int32_t d = 0; d < 2 * count; d++) {
        int32_t b = link->arc[d];
        if (b < 0 || b >= 2 * count)
            return iso_fail(ISO_BUG, "fill link: B(%d) = %d is no dart", d, b);
        if (link->arc[b] != d || b == d)
            return iso_fail(ISO_BUG, "fill link: BB = 1 without fixed points fails at dart %d", d);
        if (link->contour[b >> 1] != link->contour[d >> 1])
            return iso_fail(ISO_BUG, "fill link: pB = p fails at dart %d", d);
        if (iso_fill_link_strip(link, b) != iso_fill_link_strip(link, d))
            return iso_fail(ISO_BUG, "fill link: B leaves the strip at dart %d", d);
    }
    return ISO_OK;
}

/* F and B are involutions without fixed points, so an orbit of <F, B> is one cycle of BF and its
 * image under F. */
static void count_cells(iso_fill_census *census, const iso_fill_link *link, uint8_t *seen) {
    for (int32_t d = 0; d < 2 * link->count; d++) {
        if (seen[d])
            continue;
        int32_t size = 0;
        for (int32_t e = d; !seen[e]; e = link->arc[iso_fill_link_across(e)]) {
            seen[e] = seen[iso_fill_link_across(e)] = 1;
            size += 2;
        }
        census->cells++;
        census->extrema += size == 2;
        census->regular += size == 4;
        census->saddles += size >= 6;
    }
}

static int32_t find_root(int32_t *root, int32_t i) {
    while (root[i] != i)
        i = root[i] = root[root[i]];
    return i;
}

/* Orbits of <S, B> are the contours; F joins the contours of a part. */
static void count_parts(iso_fill_census *census, const iso_fill_link *link, int32_t *root) {
    for (int32_t i = 0; i < link->contour_count; i++)
        root[i] = -1;
    for (int32_t c = 0; c < link->count; c++)
        if (root[link->contour[c]] < 0) {
            root[link->contour[c]] = link->contour[c];
            census->contours++;
        }
    census->parts = census->contours;
    for (int32_t c = 0; c < link->count; c += 2) {
        int32_t a = find_root(root, link->contour[c]), b = find_root(root, link->contour[c + 1]);
        census->parts -= a != b;
        root[a > b ? a : b] = a < b ? a : b;
    }
}

iso_status iso_fill_link_count(iso_fill_census *census, const iso_fill_link *link,
                               iso_arena *scratch) {
    *census = (iso_fill_census){.segments = link->count / 2};
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    uint8_t *seen;
    int32_t *root;
    iso_status status = ISO_PUSH(seen, scratch, 2 * (int64_t)link->count);
    if (status == ISO_OK)
        status = ISO_PUSH(root, scratch, link->contour_count);
    if (status == ISO_OK) {
        memset(seen, 0, 2 * (size_t)link->count);
        count_cells(census, link, seen);
        count_parts(census, link, root);
    }
    iso_arena_pop(scratch, mark);
    return status;
}
