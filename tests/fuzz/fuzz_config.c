/* Bytes as a configuration: what is taken can be written and read back to the same. */
#include "fuzz.h"

#include <string.h>
#include <unistd.h>

#include <isoslice/config.h>

static char path[64];

static void write_file(const void *bytes, size_t size) {
    snprintf(path, sizeof path, "fuzz-config.%ld", (long)getpid());
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        abort();
}

/* The value as text, set again, is the same text. */
static iso_status set_again(void *payload, const char *key, const char *value) {
    static char text[1 << 16];
    iso_options *again = payload;
    fuzz_right(iso_options_set(again, key, value, "again"));
    size_t length = iso_options_format(text, sizeof text, again, iso_option_find(key));
    if (length < sizeof text && strcmp(text, value) != 0) {
        fprintf(stderr, "%s: \"%s\" became \"%s\"\n", key, value, text);
        abort();
    }
    return ISO_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static iso_options options, again;
    static iso_config_notes notes;
    memset(&notes, 0, sizeof notes);
    iso_options_defaults(&options);
    iso_options_defaults(&again);
    write_file(bytes, size);
    iso_status status = iso_options_read(&options, path, &notes);
    remove(path);
    if (status != ISO_OK && status != ISO_BAD_CONFIG && status != ISO_UNREADABLE)
        fuzz_right(status);
    if (status == ISO_OK)
        fuzz_right(iso_options_print_changed(&options, set_again, &again));
    return 0;
}
