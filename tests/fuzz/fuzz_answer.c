/* Bytes as what a printer says: the same answers in any pieces, each within its bounds. */
#include "fuzz.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "protocol/answer.h"
#include "protocol/firmware.h"

typedef struct record {
    uint64_t hash;
    fio_firmware firmware;
} record;

static void must(bool condition) {
    if (!condition)
        abort();
}

static void take(void *context, const fio_answer *a) {
    record *r = context;
    must(a->length > 0 && a->length <= FIO_ANSWER_MOST && a->text[a->length] == 0);
    must(a->rest >= a->text && a->rest + a->rest_length <= a->text + a->length);
    must(a->kind >= 0 && a->kind < FIO_ANSWER_KINDS && a->line >= -1);
    must(a->kind != FIO_ANSWER_RESEND || a->line >= 0);
    must(a->planner_free >= -1 && a->commands_free >= -1);
    must(isfinite(a->bed) && isfinite(a->position[0] + a->position[3]));
    for (int i = 0; i < FIO_ANSWER_TOOLS; i++)
        must(isfinite(a->nozzle[i]) && isfinite(a->nozzle_target[i]));
    must(a->has_temperatures == (a->nozzles != 0 || a->has_bed));
    (void)fio_firmware_identify(a);
    fio_firmware_learn(&r->firmware, a);
    must(r->firmware.command_slots >= 1 && r->firmware.command_slots <= 64);
    must(r->firmware.receive_bytes >= 0 && r->firmware.receive_bytes <= 255);
    must(r->firmware.tools >= 1 && r->firmware.tools <= FIO_ANSWER_TOOLS);
    (void)fio_command_traits(a->text, a->length);
    for (size_t i = 0; i < a->length; i++)
        r->hash = (r->hash ^ (unsigned char)a->text[i]) * 1099511628211u;
    r->hash = (r->hash ^ (uint64_t)a->kind ^ a->cut) * 31 + (uint64_t)a->line;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static fio_answer_parser parser;
    record whole = {.firmware = *fio_firmware_of(FIO_FIRMWARE_MARLIN)}, pieces = whole;
    size_t piece = size > 0 ? 1 + bytes[size / 2] % 16 : 1;
    fio_answer_parser_reset(&parser);
    fio_answer_parser_feed(&parser, bytes, size, take, &whole);
    fio_answer_parser_feed(&parser, "\n", 1, take, &whole);
    for (size_t at = 0; at < size; at += piece)
        fio_answer_parser_feed(&parser, bytes + at, piece < size - at ? piece : size - at, take,
                               &pieces);
    fio_answer_parser_feed(&parser, "\n", 1, take, &pieces);
    must(whole.hash == pieces.hash);
    return 0;
}
