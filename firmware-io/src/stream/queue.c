/* Commands of the host that wait for their turn between those of the job. */
#include <string.h>

#include "stream/state.h"

bool fio_queue_is_empty(const fio_streamer *streamer) {
    return streamer->host_first == streamer->host_last;
}

int fio_queue_room(const fio_streamer *streamer) {
    return FIO_HOST_QUEUE - (int)(streamer->host_last - streamer->host_first);
}

void fio_queue_clear(fio_streamer *streamer) {
    streamer->host_first = streamer->host_last = 0;
    streamer->await_queued = false;
    streamer->await = -1;
}

static fio_host_command *append(fio_streamer *streamer) {
    if (fio_queue_room(streamer) == 0)
        return NULL;
    return &streamer->host[streamer->host_last++ % FIO_HOST_QUEUE];
}

bool fio_queue_command(fio_streamer *streamer, const char *text, size_t length) {
    if (length == 0)
        return true;
    fio_host_command *command = length <= FIO_WIRE_LINE_MOST ? append(streamer) : NULL;
    if (!command)
        return false;
    memcpy(command->text, text, length);
    command->text[length] = 0;
    command->length = (uint16_t)length;
    command->marker = false;
    return true;
}

void fio_queue_text(fio_streamer *streamer, const char *text) {
    while (text && *text) {
        size_t length = strcspn(text, "\n");
        if (!fio_queue_command(streamer, text, length))
            fio_streamer_warn(streamer, "no room for the command \"%.*s\"", (int)length, text);
        text += length + (text[length] != 0);
    }
}

void fio_queue_restore(fio_streamer *streamer, const char *text) {
    while (*text) {
        size_t length = strcspn(text, "\n");
        bool known = streamer->firmware.kind != FIO_FIRMWARE_GRBL ||
                     (*text == 'G' && !memchr(text, 'E', length));
        if (known && !fio_queue_command(streamer, text, length))
            fio_streamer_warn(streamer, "no room for the command \"%.*s\"", (int)length, text);
        text += length + (text[length] != 0);
    }
}

void fio_queue_await(fio_streamer *streamer) {
    fio_host_command *command = append(streamer);
    if (!command)
        command = &streamer->host[(streamer->host_last - 1) % FIO_HOST_QUEUE];
    command->length = 0;
    command->marker = true;
    streamer->await_queued = true;
    streamer->await = -1;
}

void fio_queue_raw(fio_streamer *streamer, const char *bytes, size_t size) {
    if (size > sizeof streamer->raw - streamer->raw_length)
        return;
    memcpy(streamer->raw + streamer->raw_length, bytes, size);
    streamer->raw_length += size;
}
