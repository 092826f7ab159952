/* What stands in brackets in the user's G-code. */
#ifndef ISO_CONFIG_PLACEHOLDER_H
#define ISO_CONFIG_PLACEHOLDER_H

#include <isoslice/config.h>

/* One that is no option: it has its value from where the text stands. */
typedef struct iso_placeholder {
    const char *key;
    double value;
} iso_placeholder;

/* iso_options_expand with `count` placeholders more. */
iso_status iso_placeholders_fill(char *out, size_t size, const char *text,
                                 const iso_options *options, const iso_placeholder *more,
                                 int32_t count) ISO_MUST_CHECK;

#endif
