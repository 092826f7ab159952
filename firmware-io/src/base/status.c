#include <isoprint/status.h>

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char message[512];

const char *fio_error_message(void) {
    return message;
}

fio_status fio_fail(fio_status status, const char *format, ...) {
    char text[sizeof message]; /* arguments may point into the old message */
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(message, sizeof message, "%s", text);
    return status;
}
