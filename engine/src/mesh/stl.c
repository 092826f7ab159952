/* STL, binary and ASCII, told apart by content. Read in chunks: the file is never in memory whole,
 * and mapped pages would count as memory too. */
#include <isoslice/mesh.h>

#include "mesh/stl.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "mesh/builder.h"

enum { HEADER = 80, RECORDS = 84, RECORD = 50, CORNERS = 12, CHUNK = 1 << 17, SNIFFED = 1024 };

static iso_status open_source(iso_stl_source *s, const char *path) {
    *s = (iso_stl_source){.path = path, .size = -1};
    s->file = open(path, O_RDONLY | O_CLOEXEC);
    if (s->file < 0)
        return iso_fail(ISO_UNREADABLE, "%s: %s", path, strerror(errno));
    struct stat about;
    if (fstat(s->file, &about) == 0 && S_ISREG(about.st_mode))
        s->size = about.st_size;
    iso_status status = ISO_ALLOCATE(s->buffer, CHUNK);
    if (status != ISO_OK)
        close(s->file);
    return status;
}

static void close_source(iso_stl_source *s) {
    iso_release(s->buffer);
    if (s->file >= 0)
        close(s->file);
}

iso_status iso_stl_source_fill(iso_stl_source *s) {
    size_t kept = (size_t)(s->end - s->at);
    if (s->file < 0) { /* all of it was in memory from the start */
        s->ended = true;
        return ISO_OK;
    }
    if (kept)
        memmove(s->buffer, s->buffer + s->at, kept);
    s->offset += s->at;
    s->at = 0;
    s->end = (int64_t)kept;
    while (s->end < CHUNK && !s->ended) {
        ssize_t got = read(s->file, s->buffer + s->end, (size_t)(CHUNK - s->end));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return iso_fail(ISO_UNREADABLE, "%s: %s", s->path, strerror(errno));
        s->ended = got == 0;
        s->end += got;
    }
    return ISO_OK;
}

static uint32_t little_endian(const char *at) {
    const unsigned char *u = (const unsigned char *)at;
    return u[0] | (uint32_t)u[1] << 8 | (uint32_t)u[2] << 16 | (uint32_t)u[3] << 24;
}

/* A binary file whose size agrees with its count is binary, whatever its header says. Otherwise
 * text that begins with "solid" and has no zero byte near its beginning is ASCII. */
static bool looks_ascii(const iso_stl_source *s) {
    if (s->end >= RECORDS && s->size >= 0 &&
        s->size == RECORDS + RECORD * (int64_t)little_endian(s->buffer + HEADER))
        return false;
    int64_t at = 0, seen = s->end < SNIFFED ? s->end : SNIFFED;
    if (seen >= 3 && memcmp(s->buffer, "\xef\xbb\xbf", 3) == 0)
        at = 3;
    while (at < seen && iso_stl_is_space(s->buffer[at]))
        at++;
    static const char solid[] = "solid";
    for (int i = 0; i < 5; i++)
        if (at + i >= seen || (s->buffer[at + i] | 32) != solid[i])
            return false;
    return memchr(s->buffer, 0, (size_t)seen) == NULL;
}

/* Does the count agree with the size? A file that ends before its triangles do is cut off. One that
 * holds more *whole* triangles than it says has a wrong count, and nobody knows which is meant.
 * Other bytes behind the triangles are a footer, which some programs write. */
static iso_status check_count(const iso_stl_source *s, int64_t count) {
    if (s->size < 0)
        return ISO_OK;
    int64_t room = s->size - RECORDS, held = room / RECORD;
    if (count > held)
        return iso_fail(ISO_UNREADABLE,
                        "%s: the header says %lld triangles, the file has room for %lld (%lld "
                        "bytes): it was cut off, or is no STL file",
                        s->path, (long long)count, (long long)held, (long long)s->size);
    if (count < held && room % RECORD == 0)
        return iso_fail(ISO_UNREADABLE,
                        "%s: the header says %lld triangles, the file holds %lld: one of the two "
                        "is wrong, export it again",
                        s->path, (long long)count, (long long)held);
    return ISO_OK;
}

static iso_status read_records(iso_mesh_builder *builder, iso_stl_source *s, int64_t count) {
    for (int64_t done = 0; done < count;) {
        if (s->end - s->at < RECORD)
            ISO_TRY(iso_stl_source_fill(s));
        int64_t here = (s->end - s->at) / RECORD;
        if (here == 0)
            return iso_fail(ISO_UNREADABLE,
                            "%s: the header says %lld triangles, the file ends after %lld", s->path,
                            (long long)count, (long long)done);
        if (here > count - done)
            here = count - done;
        const char *first = s->buffer + s->at + CORNERS;
        int64_t absurd = iso_mesh_builder_find_absurd(first, here, RECORD);
        if (absurd < here)
            return iso_fail(ISO_UNREADABLE,
                            "%s: triangle %lld, at byte %lld, has a coordinate that is not finite "
                            "or beyond 10 km",
                            s->path, (long long)(done + absurd),
                            (long long)(s->offset + s->at + absurd * RECORD));
        ISO_TRY(iso_mesh_builder_add(builder, first, here, RECORD));
        s->at += here * RECORD;
        done += here;
    }
    return ISO_OK;
}

static iso_status read_binary(iso_mesh_builder *builder, iso_stl_source *s) {
    if (s->end < RECORDS)
        return iso_fail(ISO_UNREADABLE, "%s: %lld bytes are too few for an STL file", s->path,
                        (long long)s->end);
    int64_t count = little_endian(s->buffer + HEADER);
    ISO_TRY(check_count(s, count));
    if (count == 0)
        return iso_fail(ISO_UNREADABLE, "%s: no triangles", s->path);
    /* without a size to check it against, the count is not worth an allocation */
    ISO_TRY(iso_mesh_builder_begin(builder, s->size < 0 ? 0 : count));
    s->at = RECORDS;
    return read_records(builder, s, count);
}

static iso_status read_source(iso_mesh *mesh, iso_stl_source *s, const iso_mesh_options *options) {
    iso_mesh_builder builder = {0};
    iso_status status = ISO_OK;
    if (s->end == 0)
        return iso_fail(ISO_UNREADABLE, "%s: the file is empty", s->path);
    if (looks_ascii(s)) {
        status = iso_mesh_builder_begin(&builder, s->size < 0 ? 0 : s->size / 270);
        if (status == ISO_OK)
            status = iso_stl_read_ascii(&builder, s);
    } else {
        status = read_binary(&builder, s);
    }
    if (status != ISO_OK) {
        iso_mesh_builder_discard(&builder);
        return status;
    }
    iso_release(s->buffer); /* the peak of memory is still to come */
    s->buffer = NULL;
    status = iso_mesh_builder_finish(mesh, &builder, options);
    if (status == ISO_UNSLICEABLE || status == ISO_UNREADABLE)
        return iso_fail(status, "%s: %s", s->path, iso_error_message());
    return status;
}

iso_status iso_mesh_read(iso_mesh *mesh, const char *path) {
    return iso_mesh_read_with(mesh, path, NULL);
}

iso_status iso_mesh_read_with(iso_mesh *mesh, const char *path, const iso_mesh_options *options) {
    *mesh = (iso_mesh){0};
    iso_stl_source source;
    ISO_TRY(open_source(&source, path));
    iso_status status = iso_stl_source_fill(&source);
    if (status == ISO_OK)
        status = read_source(mesh, &source, options);
    close_source(&source);
    return status;
}

iso_status iso_mesh_read_memory(iso_mesh *mesh, const void *bytes, int64_t size) {
    *mesh = (iso_mesh){0};
    iso_stl_source source = {
        .path = "memory", .file = -1, .size = size, .end = size, .ended = true};
    ISO_TRY(ISO_ALLOCATE(source.buffer, size));
    if (size > 0) /* bytes may be NULL then */
        memcpy(source.buffer, bytes, (size_t)size);
    iso_status status = read_source(mesh, &source, NULL);
    close_source(&source);
    return status;
}
