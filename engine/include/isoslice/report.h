/* What a job did: counts, defects, times, warnings. The job fills it in, stage by stage, and it
 * tells the truth about as far as the job came. */
#ifndef ISOSLICE_REPORT_H
#define ISOSLICE_REPORT_H

#include <stdint.h>

#include <isoslice/channel.h>
#include <isoslice/config.h>
#include <isoslice/gcode.h>
#include <isoslice/mesh.h>
#include <isoslice/planar.h>
#include <isoslice/porous.h>
#include <isoslice/status.h>

typedef struct iso_report_input {
    char *path;             /* owned by the report */
    int32_t triangle_count; /* after mending */
    int32_t vertex_count;
    iso_vec3 size;      /* mm */
    double volume;      /* mm^3 of the mended mesh */
    int64_t mesh_bytes; /* memory of the mesh */
    iso_mesh_defects defects;
} iso_report_input;

typedef struct iso_report_stage {
    const char
        *name;      /* a constant: "read", "slice", "regions", "walls", "fill", "order", "write" */
    double seconds; /* on the clock */
    int64_t bytes;  /* of what it keeps in memory, at its largest; 0: nothing */
} iso_report_stage;

/* What rays said about the contours of slices and the shells that they come from (docs/models.md).
 * Samples, unless all were asked for. */
typedef struct iso_report_solid {
    int64_t contours;         /* of the objects that were looked at */
    int64_t contours_checked; /* of those */
    int64_t contours_buried;  /* with material on both sides, as where shells overlap */
    int64_t contours_empty;   /* with material on neither */
    int64_t contours_wrong;   /* that aren't the model's section */
    int64_t points;           /* asked about */
    int64_t shells;
    int64_t shells_overlapping; /* partly within the material of others, or of themselves */
    int64_t shells_nested;      /* wholly: they bound nothing */
    int64_t shells_hollow;      /* with material on neither side: they bound nothing */
    int64_t cavities;
} iso_report_solid;

/* Codes are stable: scripts may look for them. docs/command-line.md lists them. */
typedef struct iso_report_warning {
    const char *code; /* a constant: "mesh-mended" */
    char *message;    /* owned by the report */
} iso_report_warning;

/* Zero-initialise; iso_report_free at the end. */
typedef struct iso_report {
    int32_t input_count, stage_count, warning_count;
    iso_report_input *input;
    iso_report_stage *stage;
    iso_report_warning *warning;
    int64_t input_capacity, stage_capacity, warning_capacity;

    int32_t threads;
    int32_t layer_count;
    double printed_height; /* mm, top of the last layer */
    double mesh_volume;    /* mm^3 of the meshes clipped to the printed height */
    double sliced_volume;  /* mm^3, sum of each layer's area times its height */
    iso_report_solid solid;
    const iso_porous_figures *lattice; /* of isoslice lattice, borrowed; NULL: there are none */
    const char *lattice_output; /* a constant: "mesh", "distance", "mask", "gcode"; NULL: nothing */
    int64_t lattice_triangles;  /* of the mesh */
    const iso_channel_figures *channels; /* of isoslice channels, borrowed; NULL: there are none */
    int64_t channel_triangles;           /* that were written */
    iso_planar_counts kernel;
    iso_gcode_totals print;
    double seconds;          /* of the whole job, on the clock */
    int64_t peak_memory_kib; /* of the process; 0 if not known */
} iso_report;

ISO_API void iso_report_free(iso_report *report);

/* Note a model: its path, size, volume, defects; warns of what was mended ("mesh-mended"). */
ISO_API iso_status iso_report_add_input(iso_report *report, const char *path,
                                        const iso_mesh *mesh) ISO_MUST_CHECK;
/* Warn of what was mended in a file, if anything was. */
ISO_API iso_status iso_report_warn_mended(iso_report *report, const char *path,
                                          const iso_mesh_defects *found) ISO_MUST_CHECK;
/* Note a stage, or add to it if one of that name is there. */
ISO_API iso_status iso_report_add_stage(iso_report *report, const char *name, double seconds,
                                        int64_t bytes) ISO_MUST_CHECK;
ISO_API iso_status iso_report_warn(iso_report *report, const char *code, const char *format, ...)
    ISO_PRINTF(3, 4) ISO_MUST_CHECK;

/* Write it as JSON (docs/command-line.md has the schema) with the options that differ from their
 * defaults. `status` is the job's; unless ISO_OK, `message` says why. "-" is standard output. */
ISO_API iso_status iso_report_write(const iso_report *report, const iso_options *options,
                                    iso_status status, const char *message,
                                    const char *path) ISO_MUST_CHECK;

#endif
