#include "dialogue.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "utf8.h"

fio_status fio_dialogue_open(fio_dialogue *dialogue, const char *path, const char *port) {
    dialogue->path = path;
    dialogue->start = dialogue->flushed = 0;
    if (!path)
        return FIO_OK;
    fio_status status = fio_output_create(&dialogue->output, path);
    if (status != FIO_OK) {
        dialogue->path = NULL;
        return status;
    }
    char date[32] = "", note[256], bytes[sizeof note];
    time_t now = time(NULL);
    struct tm utc;
    if (gmtime_r(&now, &utc))
        strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    snprintf(note, sizeof note, "isoprint %s on %s, %s; times in s from here", FIO_VERSION, port,
             date);
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_utf8_visible(&text, note, strlen(note));
    fio_dialogue_add(dialogue, 0, '#', bytes, text.length);
    return FIO_OK;
}

void fio_dialogue_start(fio_dialogue *dialogue, double start) {
    dialogue->start = dialogue->flushed = start;
}

void fio_dialogue_add(fio_dialogue *dialogue, double now, char who, const char *bytes,
                      size_t size) {
    char line[2400], time_text[32];
    if (!dialogue->path)
        return;
    while (size > 0 && (bytes[size - 1] == '\n' || bytes[size - 1] == '\r'))
        size--;
    fio_text text = fio_text_in(time_text, sizeof time_text);
    fio_text_number(&text, now - dialogue->start, 6);
    const char between[3] = {' ', who, ' '};
    fio_text whole = fio_text_in(line, sizeof line - 1);
    for (size_t i = text.length; i < 13; i++)
        fio_text_string(&whole, " ");
    fio_text_bytes(&whole, time_text, text.length);
    fio_text_bytes(&whole, between, sizeof between);
    fio_utf8_escaped(&whole, bytes, size);
    line[whole.length++] = '\n';
    fio_output_line(&dialogue->output, line, whole.length);
}

void fio_dialogue_flush(fio_dialogue *dialogue, double now) {
    if (!dialogue->path || now - dialogue->flushed < 1)
        return;
    fio_output_flush(&dialogue->output);
    dialogue->flushed = now;
}

fio_status fio_dialogue_close(fio_dialogue *dialogue) {
    if (!dialogue->path)
        return FIO_OK;
    const char *path = dialogue->path;
    bool whole = fio_output_close(&dialogue->output, 2);
    dialogue->path = NULL;
    if (whole)
        return FIO_OK;
    if (dialogue->output.error)
        return fio_fail(FIO_NOT_WRITTEN, "%s: could not be written: %s", path,
                        strerror(dialogue->output.error));
    return fio_fail(FIO_NOT_WRITTEN, "%s: too slow; %" PRId64 " lines or more are not in it", path,
                    dialogue->output.dropped);
}
