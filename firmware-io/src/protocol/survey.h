/* What comments tell of a job, read as they pass or ahead of them: layers and the time. */
#ifndef FIO_PROTOCOL_SURVEY_H
#define FIO_PROTOCOL_SURVEY_H

#include "protocol/input.h"

/* Slicers mark layers in one of three ways; the first that occurs counts. */
typedef enum fio_layer_mark {
    FIO_MARK_NONE,
    FIO_MARK_CHANGE, /* ";LAYER_CHANGE": PrusaSlicer, OrcaSlicer, isoslice */
    FIO_MARK_NUMBER, /* ";LAYER:12": Cura, ideaMaker */
    FIO_MARK_BAMBU   /* "; CHANGE_LAYER": Bambu Studio */
} fio_layer_mark;

/* Of a comment that begins its line, from its ';' on. */
fio_layer_mark fio_layer_mark_of(const char *comment, size_t length);

/* Seconds that a comment (from its ';' on) gives for the whole job; -1 if it tells nothing. */
double fio_comment_seconds(const char *comment, size_t length);
/* Layers likewise. */
int32_t fio_comment_layers(const char *comment, size_t length);

/* Counting the layers of something seekable, piece by piece. */
typedef struct fio_survey {
    int64_t at;      /* bytes looked at */
    int64_t carried; /* of the block's beginning, kept from the one before */
    int32_t layers;
    fio_layer_mark mark;
    bool done;
} fio_survey;

enum { FIO_SURVEY_BLOCK = 64 * 1024, FIO_SURVEY_CARRY = 32 };

/* Look at some `bytes` more; `block` is scratch of FIO_SURVEY_CARRY + FIO_SURVEY_BLOCK bytes, kept
 * between the calls. */
void fio_survey_go_on(fio_survey *survey, const fio_input *input, int64_t bytes, char *block);

#endif
