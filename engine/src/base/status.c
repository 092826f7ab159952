#include <isoslice/status.h>

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char message[1024];

const char *iso_error_message(void) {
    return message;
}

iso_status iso_fail(iso_status status, const char *format, ...) {
    char text[sizeof message]; /* arguments may point into the old message */
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(message, sizeof message, "%s", text);
    return status;
}
