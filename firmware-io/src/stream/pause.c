/* Pausing and going on, by the user's will or the printer's. */
#include <string.h>

#include "base/text.h"
#include "stream/state.h"

#define HOT 150 /* °C: colder than that nothing can be retracted */

static bool has_marlin_words(const fio_streamer *streamer) {
    return streamer->firmware.kind != FIO_FIRMWARE_GRBL;
}

static bool stands(const fio_track *track) {
    return track->homed || (track->known[0] && track->known[1] && track->known[2]);
}

static void queue_move(fio_streamer *streamer, const char *before, double value,
                       const char *after) {
    char command[64];
    fio_text text = fio_text_in(command, sizeof command);
    fio_text_string(&text, before);
    fio_text_number(&text, value, 3);
    fio_text_string(&text, after);
    fio_queue_text(streamer, command);
}

void fio_streamer_pause(fio_streamer *streamer, double now) {
    streamer->now = now;
    if (streamer->state != FIO_STREAM_RUNNING || !streamer->has_source || streamer->opened_file)
        return;
    const fio_track *track = &streamer->track;
    fio_streamer_enter(streamer, FIO_STREAM_PAUSING);
    streamer->paused = *track;
    streamer->foreign_pause = false;
    streamer->retracted = false;
    fio_queue_clear(streamer);
    fio_queue_text(streamer, has_marlin_words(streamer) ? "M400\nM114" : "G4 P0");
    if (stands(track)) {
        bool hot = track->tool >= 0 && track->tool < FIO_TRACK_TOOLS &&
                   track->nozzle[track->tool] >= HOT && has_marlin_words(streamer);
        fio_queue_text(streamer, hot ? "G21\nG91\nM83" : "G21\nG91");
        if (hot && streamer->options.retract > 0) {
            queue_move(streamer, "G1 E-", streamer->options.retract, " F1800");
            streamer->retracted = true;
        }
        if (streamer->options.lift > 0) {
            streamer->track.raised = streamer->paused.raised = streamer->options.lift;
            queue_move(streamer, "G1 Z", streamer->options.lift, " F600");
        }
        fio_queue_text(streamer, "G90");
    }
    fio_queue_text(streamer, streamer->options.on_pause);
    fio_queue_await(streamer);
}

void fio_streamer_resume(fio_streamer *streamer, double now) {
    char text[FIO_TRACK_TEXT];
    streamer->now = now;
    if (streamer->state != FIO_STREAM_PAUSED)
        return;
    if (streamer->foreign_pause || !stands(&streamer->paused)) {
        fio_streamer_enter(streamer, FIO_STREAM_RUNNING);
        return;
    }
    fio_streamer_enter(streamer, FIO_STREAM_RESUMING);
    streamer->track.raised = 0;
    fio_track_restore(&streamer->paused, false, streamer->options.lift,
                      streamer->retracted ? streamer->options.retract : 0, text);
    fio_queue_restore(streamer, text);
    fio_queue_await(streamer);
}

void fio_pause_step(fio_streamer *streamer) {
    if (streamer->state == FIO_STREAM_PAUSING)
        fio_streamer_enter(streamer, FIO_STREAM_PAUSED);
    else if (streamer->state == FIO_STREAM_RESUMING)
        fio_streamer_enter(streamer, FIO_STREAM_RUNNING);
}

/* What M114 tells of axes that the job never moved to a place of its own. */
void fio_pause_hear(fio_streamer *streamer, const fio_answer *answer) {
    if (streamer->state != FIO_STREAM_PAUSING || answer->kind != FIO_ANSWER_POSITION)
        return;
    for (int i = 0; i < 4; i++)
        if (!streamer->paused.known[i])
            streamer->paused.position[i] = answer->position[i];
}

static bool is_action(const fio_answer *answer, const char *name) {
    size_t length = strlen(name);
    return answer->rest_length >= length && memcmp(answer->rest, name, length) == 0 &&
           (answer->rest_length == length || answer->rest[length] == ' ');
}

static void prompt(fio_streamer *streamer, const fio_answer *answer) {
    if (!streamer->listener.event)
        return;
    bool ends = is_action(answer, "prompt_end");
    streamer->listener.event(streamer->listener.context,
                             &(fio_stream_event){.kind = FIO_STREAM_PROMPT,
                                                 .time = streamer->now,
                                                 .state = streamer->state,
                                                 .answer = answer,
                                                 .text = ends ? "" : answer->rest,
                                                 .length = ends ? 0 : answer->rest_length});
}

void fio_pause_action(fio_streamer *streamer, const fio_answer *answer) {
    double now = streamer->now;
    if (answer->rest_length >= 7 && !memcmp(answer->rest, "prompt_", 7)) {
        prompt(streamer, answer);
    } else if (is_action(answer, "pause") || is_action(answer, "out_of_filament")) {
        fio_streamer_pause(streamer, now);
    } else if (is_action(answer, "paused")) {
        if (streamer->state == FIO_STREAM_RUNNING && streamer->has_source) {
            streamer->foreign_pause = true;
            fio_streamer_enter(streamer, FIO_STREAM_PAUSED);
        }
    } else if (is_action(answer, "resume") || is_action(answer, "resumed")) {
        fio_streamer_resume(streamer, now);
    } else if (is_action(answer, "cancel") || is_action(answer, "abort")) {
        fio_end(streamer, FIO_CANCELLED, false, "cancelled at the printer");
    } else if (is_action(answer, "disconnect")) {
        fio_end(streamer, FIO_LINK_LOST, false, "the printer asked to be let go");
    } else if (is_action(answer, "shutdown")) {
        fio_end(streamer, FIO_CANCELLED, false, "the printer asked for the host to shut down");
    }
}
