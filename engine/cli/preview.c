/* isoslice preview: layers of a G-code file as a picture. */
#include <isoslice/preview.h>

#include "verbs.h"

iso_status iso_verb_preview(const iso_arguments *arguments) {
    char name[4096];
    const char *path = arguments->output;
    ISO_TRY(iso_one_file(arguments));
    if (!path) {
        ISO_TRY(iso_replace_ending(name, sizeof name, arguments->file[0], ".svg"));
        path = name;
    }
    ISO_TRY(iso_keep_files(arguments, path));
    iso_preview_options options = iso_preview_defaults();
    options.layer = arguments->layer;
    options.layer_count = arguments->layer_count;
    options.travels = arguments->travels;
    if (arguments->view_given) {
        options.view[0] = arguments->view[0];
        options.view[1] = arguments->view[1];
    }
    if (arguments->columns > 0)
        options.columns = arguments->columns;
    return iso_preview_svg(path, arguments->file[0], &options);
}
