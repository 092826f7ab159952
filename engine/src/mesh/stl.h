/* The parts of the STL reader. */
#ifndef ISO_MESH_STL_H
#define ISO_MESH_STL_H

#include <isoslice/mesh.h>

#include <stdbool.h>

#include "mesh/builder.h"

/* A file seen through a window that moves on. */
typedef struct iso_stl_source {
    const char *path; /* for messages */
    int file;         /* -1: everything is in the buffer already */
    int64_t size;     /* bytes, or -1 where the system does not know (a pipe) */
    char *buffer;
    int64_t at, end; /* unread bytes of the buffer */
    int64_t offset;  /* of buffer[0] in the file */
    bool ended;
} iso_stl_source;

/* Keep the unread bytes and fill the rest of the buffer. */
iso_status iso_stl_source_fill(iso_stl_source *source) ISO_MUST_CHECK;

iso_status iso_stl_read_ascii(iso_mesh_builder *builder, iso_stl_source *source) ISO_MUST_CHECK;

/* iso_mesh_read on a file that is in memory. */
iso_status iso_mesh_read_memory(iso_mesh *mesh, const void *bytes, int64_t size) ISO_MUST_CHECK;

static inline bool iso_stl_is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

#endif
