/* Lists of what configurations had that isn't ours (iso_config_notes in config.h). */
#ifndef ISO_CONFIG_NOTES_H
#define ISO_CONFIG_NOTES_H

#include <isoslice/config.h>

/* Each once. */
void iso_notes_add_unknown(iso_config_notes *notes, const char *key);

/* One a key: the last. */
void iso_notes_add_unused(iso_config_notes *notes, const char *key, const char *value);

/* The key has been set to something we know. */
void iso_notes_drop_unused(iso_config_notes *notes, const char *key);

#endif
