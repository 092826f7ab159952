/* Bytes as a job: what is read is in order and comes again after a seek, and what is sent of it is
 * a line that its own checksum fits. */
#include "fuzz.h"

#include <stdbool.h>
#include <string.h>

#include "protocol/encode.h"
#include "protocol/firmware.h"
#include "protocol/meatpack.h"
#include "protocol/source.h"
#include "protocol/track.h"

static void must(bool condition) {
    if (!condition)
        abort();
}

static void send(const fio_source_command *command) {
    static char wire[FIO_WIRE_LINE_MOST + 1], text[FIO_COMMAND_MOST + 3];
    static unsigned char packed[2 * FIO_WIRE_LINE_MOST + 8];
    size_t length = fio_encode_disguised(text, command->text, command->length);
    must(length >= command->length && length <= command->length + 2 && text[length] == 0);
    size_t most = 20 + command->length % 90;
    size_t size = fio_encode_line(wire, command->index, text, length, most);
    must(wire[size] == 0 && size <= most + 1);
    if (size == 0)
        return;
    const char *star = strrchr(wire, '*');
    must(wire[size - 1] == '\n' && strlen(wire) == size && strchr(wire, ';') == NULL);
    must(strcspn(wire, "\n\r\b\\()") == size - 1);
    must(strtoul(star + 1, NULL, 10) == fio_checksum(wire, (size_t)(star - wire)));
    fio_meatpack packer;
    (void)fio_meatpack_begin(&packer, size % 2, packed);
    must(fio_meatpack_line(&packer, wire, size, packed) <= 2 * size + 8);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static char text[FIO_TRACK_TEXT];
    fio_source *source = NULL;
    fio_source_command command;
    fio_source_result result;
    fio_track track;
    int64_t count = 0, line = 0, offset = 0, hash = 0;
    int32_t layer = 0;
    must(fio_source_memory(&source, (const char *)bytes, size) == FIO_OK);
    fio_track_reset(&track);
    while ((result = fio_source_next(source, &command)) == FIO_SOURCE_COMMAND) {
        must(command.length > 0 && command.length <= FIO_COMMAND_MOST);
        must(command.text[command.length] == 0 && command.index == count);
        must(command.line > line && command.offset > offset && command.layer >= layer);
        must(command.offset <= (int64_t)size);
        line = command.line;
        offset = command.offset;
        layer = command.layer;
        if (count++ == 3)
            hash = command.offset + command.line * 65536;
        (void)fio_command_traits(command.text, command.length);
        fio_track_follow(&track, command.text, command.length);
        send(&command);
    }
    must(result == FIO_SOURCE_END || result == FIO_SOURCE_FAILED);
    int32_t layers = fio_source_whole(source)->layers; /* more may come behind the last command */
    must(layers < 0 ? layer == 0 : layers >= layer);
    size_t length = fio_track_restore(&track, size % 2, 2, 1, text);
    must(length == strlen(text) && length < FIO_TRACK_TEXT - 1);
    if (count > 3) {
        must(fio_source_seek(source, 3) == FIO_OK);
        must(fio_source_next(source, &command) == FIO_SOURCE_COMMAND && command.index == 3);
        must(hash == command.offset + command.line * 65536);
    }
    fio_source_close(source);
    return 0;
}
