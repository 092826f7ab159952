#include "mesh/stl.h"

#include <string.h>

#include "base/memory.h"
#include "mesh/decimal.h"

/* Tokens between white space; keywords in any case. Lines end with LF, CR or CRLF. */
enum {
    LONGEST = 1024, /* a token is not longer than this, or the file is no STL file */
    BATCH = 128     /* triangles handed on at a time */
};

typedef struct reader {
    iso_stl_source *source;
    iso_mesh_builder *builder;
    int64_t line;
    const char *token;
    int length;
    float triangle[9 * BATCH];
    int count;
} reader;

static void count_line(reader *r, char c, char before) {
    r->line += c == '\r' || (c == '\n' && before != '\r');
}

static iso_status skip_space(reader *r) {
    iso_stl_source *s = r->source;
    char before = 0;
    for (;;) {
        while (s->at < s->end && iso_stl_is_space(s->buffer[s->at])) {
            char c = s->buffer[s->at++];
            count_line(r, c, before);
            before = c;
        }
        if (s->at < s->end || s->ended)
            return ISO_OK;
        ISO_TRY(iso_stl_source_fill(s));
    }
}

/* length 0: the end of the file. */
static iso_status next_token(reader *r) {
    iso_stl_source *s = r->source;
    ISO_TRY(skip_space(r));
    if (s->end - s->at < LONGEST && !s->ended)
        ISO_TRY(iso_stl_source_fill(s));
    r->token = s->buffer + s->at;
    int64_t limit = s->end - s->at < LONGEST ? s->end - s->at : LONGEST;
    int length = 0;
    while (length < limit && !iso_stl_is_space(r->token[length]))
        length++;
    if (length == LONGEST)
        return iso_fail(ISO_UNREADABLE, "%s: line %lld: %d characters without a space", s->path,
                        (long long)r->line, LONGEST);
    r->length = length;
    s->at += length;
    return ISO_OK;
}

static bool token_is(const reader *r, const char *word) {
    int i = 0;
    for (; i < r->length && word[i]; i++)
        if ((r->token[i] | 32) != word[i])
            return false;
    return i == r->length && !word[i];
}

static iso_status unexpected(const reader *r, const char *wanted) {
    if (r->length == 0)
        return iso_fail(ISO_UNREADABLE, "%s: the file ends at line %lld, where \"%s\" should be",
                        r->source->path, (long long)r->line, wanted);
    char shown[33];
    int length = r->length < 32 ? r->length : 32;
    for (int i = 0; i < length; i++)
        shown[i] = r->token[i] >= ' ' && r->token[i] <= '~' ? r->token[i] : '?';
    shown[length] = 0;
    return iso_fail(ISO_UNREADABLE, "%s: line %lld: \"%s\" where \"%s\" should be", r->source->path,
                    (long long)r->line, shown, wanted);
}

static iso_status expect(reader *r, const char *word) {
    ISO_TRY(next_token(r));
    return token_is(r, word) ? ISO_OK : unexpected(r, word);
}

/* A solid's name is whatever follows on its line. */
static iso_status skip_line(reader *r) {
    iso_stl_source *s = r->source;
    for (;;) {
        while (s->at < s->end && s->buffer[s->at] != '\n' && s->buffer[s->at] != '\r')
            s->at++;
        if (s->at < s->end || s->ended)
            return ISO_OK;
        ISO_TRY(iso_stl_source_fill(s));
    }
}

static iso_status read_vertex(reader *r, float *at) {
    ISO_TRY(expect(r, "vertex"));
    for (int k = 0; k < 3; k++) {
        ISO_TRY(next_token(r));
        const char *end = r->token + r->length;
        if (iso_decimal_parse(&at[k], r->token, end) != end)
            return unexpected(r, "a number");
        float size = at[k] < 0 ? -at[k] : at[k];
        if (!(size <= ISO_MESH_COORDINATE_MAX)) {
            long long triangle = r->builder->mesh.defects.triangles_read + r->count;
            return iso_fail(ISO_UNREADABLE,
                            "%s: line %lld: triangle %lld has a coordinate that is not finite or "
                            "beyond 10 km",
                            r->source->path, (long long)r->line, triangle);
        }
    }
    return ISO_OK;
}

static iso_status flush(reader *r) {
    int count = r->count;
    r->count = 0;
    return iso_mesh_builder_add(r->builder, r->triangle, count, 9 * sizeof(float));
}

/* Behind "facet". The normal is not read: the corners say it better, and some programs write "nan"
 * there. */
static iso_status read_facet(reader *r) {
    ISO_TRY(expect(r, "normal"));
    for (int k = 0; k < 3; k++) {
        ISO_TRY(next_token(r));
        if (r->length == 0)
            return unexpected(r, "a number");
    }
    ISO_TRY(expect(r, "outer"));
    ISO_TRY(expect(r, "loop"));
    for (int k = 0; k < 3; k++)
        ISO_TRY(read_vertex(r, r->triangle + 9 * r->count + 3 * k));
    ISO_TRY(expect(r, "endloop"));
    ISO_TRY(expect(r, "endfacet"));
    return ++r->count == BATCH ? flush(r) : ISO_OK;
}

static iso_status read_solid(reader *r) {
    for (;;) {
        ISO_TRY(next_token(r));
        if (token_is(r, "endsolid"))
            return skip_line(r);
        if (!token_is(r, "facet"))
            return unexpected(r, "facet");
        ISO_TRY(read_facet(r));
    }
}

iso_status iso_stl_read_ascii(iso_mesh_builder *builder, iso_stl_source *source) {
    reader r = {.source = source, .builder = builder, .line = 1};
    if (source->end >= 3 && memcmp(source->buffer, "\xef\xbb\xbf", 3) == 0)
        source->at = 3;
    for (;;) {
        ISO_TRY(next_token(&r));
        if (r.length == 0)
            break;
        if (!token_is(&r, "solid"))
            return unexpected(&r, "solid");
        ISO_TRY(skip_line(&r));
        ISO_TRY(read_solid(&r));
    }
    ISO_TRY(flush(&r));
    if (builder->mesh.defects.triangles_read == 0)
        return iso_fail(ISO_UNREADABLE, "%s: no triangles", source->path);
    return ISO_OK;
}
