/* One file format for every kind (docs/link-file.md). */
#include "link/multilink.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/output.h"

/* Arrays go to the file as they lie in memory. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "multi-link files are little-endian");

enum { FILE_VERSION = 1, BLOCK_ALIGNMENT = 8 };

static const char magic[8] = {'I', 'S', 'O', 'L', 'I', 'N', 'K', '\n'};

typedef struct file_header {
    char magic[8];
    int32_t version;
    int32_t header_size; /* of this and the columns */
    int32_t kind;
    int32_t size;
    int32_t map_count;
    int32_t projection_count;
    int32_t dimension;
    int32_t number; /* bytes of a coordinate: 4, 8, or 0 without geometry */
    int32_t reserved[6];
} file_header;

typedef struct file_column {
    char name[ISO_LINK_NAME_SIZE];
    int32_t rule, stride, length, range;
} file_column;

_Static_assert(sizeof(file_header) == 64 && sizeof(file_column) == 32, "layouts of the format");

static int64_t aligned(int64_t size) {
    return (size + BLOCK_ALIGNMENT - 1) / BLOCK_ALIGNMENT * BLOCK_ALIGNMENT;
}

static void write_block(iso_output *output, const void *bytes, int64_t size) {
    static const char zeros[BLOCK_ALIGNMENT];
    iso_output_write(output, bytes, (size_t)size);
    iso_output_write(output, zeros, (size_t)(aligned(size) - size));
}

static void write_columns(iso_output *output, const iso_map *map, int count) {
    for (int i = 0; i < count; i++) {
        file_column column = {.rule = map[i].rule,
                              .stride = map[i].stride,
                              .length = map[i].length,
                              .range = map[i].range};
        memcpy(column.name, map[i].name, sizeof column.name);
        iso_output_write(output, &column, sizeof column);
    }
}

static void write_images(iso_output *output, const iso_map *map, int count, int32_t size) {
    for (int i = 0; i < count; i++)
        if (map[i].rule == ISO_MAP_STORED && size > 0)
            write_block(output, map[i].image, (int64_t)size * 4);
}

static void write_geometry(iso_output *output, const iso_multilink *link, int number) {
    int64_t count = (int64_t)link->size * link->dimension;
    if (number == ISO_LINK_FLOAT64) {
        write_block(output, link->g, count * 8);
        return;
    }
    float chunk[1024];
    for (int64_t i = 0; i < count;) {
        int64_t n = count - i < 1024 ? count - i : 1024;
        for (int64_t k = 0; k < n; k++)
            chunk[k] = (float)link->g[i + k];
        i += n;
        if (i < count)
            iso_output_write(output, chunk, (size_t)n * 4);
        else
            write_block(output, chunk, n * 4); /* whole chunks before it keep the alignment */
    }
}

iso_status iso_multilink_write(const char *path, const iso_multilink *link,
                               iso_link_number number) {
    iso_output *output;
    if (number != ISO_LINK_FLOAT32 && number != ISO_LINK_FLOAT64)
        return iso_fail(ISO_USAGE, "coordinates of %d bytes; 4 and 8 are possible", (int)number);
    ISO_TRY(iso_multilink_check_shape(link, ISO_USAGE));
    ISO_TRY(iso_output_open(&output, path));
    int columns = link->map_count + link->projection_count;
    file_header header = {.version = FILE_VERSION,
                          .header_size =
                              (int32_t)(sizeof header + (size_t)columns * sizeof(file_column)),
                          .kind = link->kind,
                          .size = link->size,
                          .map_count = link->map_count,
                          .projection_count = link->projection_count,
                          .dimension = link->dimension,
                          .number = link->dimension > 0 ? (int32_t)number : 0};
    memcpy(header.magic, magic, sizeof magic);
    iso_output_write(output, &header, sizeof header);
    write_columns(output, link->map, link->map_count);
    write_columns(output, link->projection, link->projection_count);
    write_images(output, link->map, link->map_count, link->size);
    if (link->dimension > 0 && link->size > 0)
        write_geometry(output, link, header.number);
    write_images(output, link->projection, link->projection_count, link->size);
    return iso_output_commit(output);
}

/* The bytes of a file, and how many of them are read. */
typedef struct source {
    const char *bytes;
    int64_t size, at;
} source;

static iso_status read_header(file_header *header, source *from) {
    if (from->size < (int64_t)sizeof *header)
        return iso_fail(ISO_UNREADABLE, "%lld bytes are too few for a multi-link file",
                        (long long)from->size);
    memcpy(header, from->bytes, sizeof *header);
    from->at = sizeof *header;
    if (memcmp(header->magic, magic, sizeof magic) != 0)
        return iso_fail(ISO_UNREADABLE, "not a multi-link file: it begins with other bytes");
    if (header->version != FILE_VERSION)
        return iso_fail(ISO_UNREADABLE, "version %d of the multi-link format; only %d is known",
                        header->version, FILE_VERSION);
    const iso_kind_row *row = iso_kind_get((iso_link_kind)header->kind);
    if (!row || header->size < 0 || header->map_count < row->map_least ||
        header->map_count > row->map_most || header->projection_count < row->projection_count ||
        header->projection_count > ISO_LINK_MAPS_MAX || header->dimension < 0 ||
        header->dimension > ISO_LINK_DIMENSION_MAX)
        return iso_fail(ISO_UNREADABLE,
                        "no multi-link has kind %d, size %d, %d maps, %d projections, dimension %d",
                        header->kind, header->size, header->map_count, header->projection_count,
                        header->dimension);
    if (header->dimension > 0
            ? header->number != ISO_LINK_FLOAT32 && header->number != ISO_LINK_FLOAT64
            : header->number != 0)
        return iso_fail(ISO_UNREADABLE, "coordinates of %d bytes in dimension %d", header->number,
                        header->dimension);
    for (int i = 0; i < 6; i++)
        if (header->reserved[i] != 0)
            return iso_fail(ISO_UNREADABLE, "byte %d of the header is not 0",
                            (int)offsetof(file_header, reserved) + 4 * i);
    return ISO_OK;
}

static iso_status read_columns(iso_map *map, int count, source *from) {
    for (int i = 0; i < count; i++) {
        file_column column;
        memcpy(&column, from->bytes + from->at, sizeof column);
        from->at += sizeof column;
        size_t length = strnlen(column.name, sizeof column.name);
        for (size_t k = 0; k < sizeof column.name; k++)
            if (length == 0 || length == sizeof column.name ||
                (k < length ? (unsigned char)column.name[k] < 0x20 : column.name[k] != 0))
                return iso_fail(ISO_UNREADABLE, "column %d of the header has no proper name", i);
        if (column.rule < ISO_MAP_STORED || column.rule > ISO_MAP_COORDINATE)
            return iso_fail(ISO_UNREADABLE, "%s has rule %d; rules are 0 to 3", column.name,
                            column.rule);
        memcpy(map[i].name, column.name, sizeof map[i].name);
        iso_map_step(&map[i], (iso_map_rule)column.rule, column.stride, column.length,
                     column.range);
    }
    return ISO_OK;
}

static int stored_count(const iso_map *map, int count) {
    int stored = 0;
    for (int i = 0; i < count; i++)
        stored += map[i].rule == ISO_MAP_STORED;
    return stored;
}

/* Before anything is allocated: is the file exactly as long as its header says? */
static iso_status check_length(const iso_multilink *link, const file_header *header,
                               const source *from) {
    int64_t stored = stored_count(link->map, link->map_count) +
                     stored_count(link->projection, link->projection_count);
    int64_t expected = header->header_size + stored * aligned((int64_t)link->size * 4) +
                       aligned((int64_t)link->size * link->dimension * header->number);
    if (expected != from->size)
        return iso_fail(ISO_UNREADABLE, "%lld bytes; by its header the file has %lld",
                        (long long)from->size, (long long)expected);
    return ISO_OK;
}

static iso_status read_images(iso_map *map, int count, int32_t size, source *from) {
    for (int i = 0; i < count; i++) {
        if (map[i].rule != ISO_MAP_STORED)
            continue;
        int32_t *image = iso_map_allocate(&map[i], size, map[i].range);
        if (!image)
            return ISO_NO_MEMORY;
        memcpy(image, from->bytes + from->at, (size_t)size * sizeof *image);
        from->at += aligned((int64_t)size * 4);
    }
    return ISO_OK;
}

static iso_status read_geometry(iso_multilink *link, int number, source *from) {
    if (link->dimension == 0)
        return ISO_OK;
    int64_t count = (int64_t)link->size * link->dimension;
    double *g = iso_multilink_allocate_g(link);
    if (!g)
        return ISO_NO_MEMORY;
    if (number == ISO_LINK_FLOAT64)
        memcpy(g, from->bytes + from->at, (size_t)count * sizeof *g);
    else
        for (int64_t i = 0; i < count; i++) {
            float x;
            memcpy(&x, from->bytes + from->at + 4 * i, sizeof x);
            g[i] = (double)x;
        }
    from->at += aligned(count * number);
    return ISO_OK;
}

static iso_status decode(iso_multilink *made, source *from) {
    file_header header;
    ISO_TRY(read_header(&header, from));
    made->kind = (iso_link_kind)header.kind;
    made->size = header.size;
    made->map_count = header.map_count;
    made->projection_count = header.projection_count;
    made->dimension = header.dimension;
    int64_t columns = (int64_t)sizeof(file_column) * (made->map_count + made->projection_count);
    if (header.header_size != (int64_t)sizeof header + columns || header.header_size > from->size)
        return iso_fail(ISO_UNREADABLE, "a header of %d bytes does not fit its columns",
                        header.header_size);
    ISO_TRY(read_columns(made->map, made->map_count, from));
    ISO_TRY(read_columns(made->projection, made->projection_count, from));
    ISO_TRY(check_length(made, &header, from));
    ISO_TRY(read_images(made->map, made->map_count, made->size, from));
    ISO_TRY(read_geometry(made, header.number, from));
    ISO_TRY(read_images(made->projection, made->projection_count, made->size, from));
    return iso_multilink_check_shape(made, ISO_UNREADABLE);
}

iso_status iso_multilink_decode(iso_multilink *link, const void *bytes, size_t size) {
    source from = {bytes, (int64_t)size, 0};
    iso_multilink made = {.owns = 1};
    *link = (iso_multilink){0};
    iso_status status = size > PTRDIFF_MAX ? iso_no_memory(size) : decode(&made, &from);
    if (status == ISO_OK)
        *link = made;
    else
        iso_multilink_free(&made);
    return status;
}

/* Read to the end rather than ask for the size: pipes have none. */
static iso_status read_all(char **bytes, int64_t *size, FILE *file, const char *path) {
    int64_t capacity = 0;
    for (size_t n = 1; n > 0; *size += (int64_t)n) {
        ISO_TRY(ISO_GROW(*bytes, capacity, *size + (64 << 10)));
        n = fread(*bytes + *size, 1, (size_t)(capacity - *size), file);
    }
    return ferror(file) ? iso_fail(ISO_UNREADABLE, "%s: can't be read: %s", path, strerror(errno))
                        : ISO_OK;
}

iso_status iso_multilink_read(iso_multilink *link, const char *path) {
    char *bytes = NULL;
    int64_t size = 0;
    *link = (iso_multilink){0};
    FILE *file = fopen(path, "rb");
    if (!file)
        return iso_fail(ISO_UNREADABLE, "%s: can't be opened: %s", path, strerror(errno));
    iso_status status = read_all(&bytes, &size, file, path);
    fclose(file);
    if (status == ISO_OK) {
        status = iso_multilink_decode(link, bytes, (size_t)size);
        if (status == ISO_UNREADABLE)
            status = iso_fail(status, "%s: %s", path, iso_error_message());
    }
    iso_release(bytes);
    return status;
}
