#include "screen.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "terminal.h"
#include "utf8.h"

static const char to_begin_and_clear[] = "\r\x1b[K";

void fio_screen_open(fio_screen *screen, bool quiet) {
    fio_output_share(&screen->output, STDERR_FILENO);
    screen->is_terminal = isatty(STDERR_FILENO);
    screen->quiet = quiet;
    screen->line_shown = false;
    screen->line[0] = 0;
}

/* Cut to the width: a line that wraps can't be drawn over. */
static void draw(fio_screen *screen) {
    char bytes[sizeof screen->line + 32];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    int columns = fio_terminal_columns(STDERR_FILENO);
    size_t length = strlen(screen->line), used = 0;
    for (int column = 1; used < length && column < columns; column++) {
        size_t next = fio_utf8_character(screen->line + used, length - used);
        used += next > 0 ? next : 1;
    }
    fio_text_string(&text, to_begin_and_clear);
    fio_text_bytes(&text, screen->line, used);
    /* A full output drops it, and the next one comes soon. */
    if (screen->output.length == 0)
        fio_output_line(&screen->output, bytes, text.length);
    screen->line_shown = true;
}

static void message(fio_screen *screen, const char *format, va_list arguments) {
    char bytes[4096], whole[4224];
    int length = vsnprintf(bytes, sizeof bytes, format, arguments);
    if (length < 0)
        return;
    fio_text text = fio_text_in(whole, sizeof whole);
    if (screen->line_shown)
        fio_text_string(&text, to_begin_and_clear);
    fio_text_string(&text, "isoprint: ");
    fio_text_string(&text, bytes);
    fio_text_string(&text, "\n");
    fio_output_line(&screen->output, whole, text.length);
    if (screen->line_shown)
        draw(screen);
}

void fio_screen_say(fio_screen *screen, const char *format, ...) {
    va_list arguments;
    if (screen->quiet)
        return;
    va_start(arguments, format);
    message(screen, format, arguments);
    va_end(arguments);
}

void fio_screen_fail(fio_screen *screen, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    message(screen, format, arguments);
    va_end(arguments);
}

void fio_screen_line(fio_screen *screen, const char *text) {
    if (!screen->is_terminal || screen->quiet)
        return;
    if (screen->line_shown && !strcmp(screen->line, text))
        return;
    snprintf(screen->line, sizeof screen->line, "%s", text);
    draw(screen);
}

void fio_screen_redraw(fio_screen *screen) {
    if (screen->line_shown)
        draw(screen);
}

void fio_screen_close(fio_screen *screen) {
    if (screen->line_shown)
        fio_output_line(&screen->output, "\n", 1);
    screen->line_shown = false;
    (void)fio_output_close(&screen->output, 1);
}
