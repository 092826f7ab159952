/* One PNG file as grey values; part of isoslice-volume.so. */
#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include "solid/volume_table.h"

/* Larger ones are no pictures of a part: 2^15 pixels of 10 um are 330 mm. */
enum { PICTURE_EDGE_MAX = 1 << 15 };

typedef struct reading {
    FILE *file;
    png_structp png;
    png_infop info;
    volume_picture *picture;
    char *message;
    iso_status status;
} reading;

static void refuse(png_structp png, png_const_charp text) {
    reading *r = png_get_error_ptr(png);
    if (r->status == ISO_OK) {
        r->status = ISO_UNREADABLE;
        snprintf(r->message, VOLUME_MESSAGE, "is no sound PNG picture: %s", text);
    }
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp text) {
    (void)png;
    (void)text;
}

static void read_bytes(png_structp png, png_bytep bytes, size_t size) {
    reading *r = png_get_io_ptr(png);
    if (fread(bytes, 1, size, r->file) != size)
        refuse(png, "it is cut off");
}

/* Whatever it was: one byte a pixel. */
static void make_grey(png_structp png, png_infop info) {
    int colour = png_get_color_type(png, info);
    if (colour == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(png);
    if (colour == PNG_COLOR_TYPE_GRAY && png_get_bit_depth(png, info) < 8)
        png_set_expand_gray_1_2_4_to_8(png);
    png_set_scale_16(png);
    png_set_strip_alpha(png);
    if (colour & PNG_COLOR_MASK_COLOR)
        png_set_rgb_to_gray_fixed(png, PNG_ERROR_ACTION_NONE, PNG_RGB_TO_GRAY_DEFAULT,
                                  PNG_RGB_TO_GRAY_DEFAULT);
}

/* Leaves by longjmp on any failure: what it holds is in *r. */
static void decode(reading *r) {
    png_set_user_limits(r->png, PICTURE_EDGE_MAX, PICTURE_EDGE_MAX);
    png_set_read_fn(r->png, r, read_bytes);
    png_read_info(r->png, r->info);
    make_grey(r->png, r->info);
    int passes = png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    volume_picture *picture = r->picture;
    picture->width = (int32_t)png_get_image_width(r->png, r->info);
    picture->height = (int32_t)png_get_image_height(r->png, r->info);
    if (png_get_rowbytes(r->png, r->info) != (size_t)picture->width)
        refuse(r->png, "its pixels can't be made grey");
    picture->value = picture->allocate((size_t)picture->width * (size_t)picture->height);
    if (!picture->value) {
        r->status = ISO_NO_MEMORY;
        snprintf(r->message, VOLUME_MESSAGE, "out of memory for %d x %d pixels", picture->width,
                 picture->height);
        png_longjmp(r->png, 1);
    }
    for (int pass = 0; pass < passes; pass++)
        for (int32_t y = 0; y < picture->height; y++)
            png_read_row(r->png, picture->value + (size_t)y * (size_t)picture->width, NULL);
    png_read_end(r->png, NULL);
}

static void read_file(reading *r) {
    unsigned char head[8];
    size_t size = fread(head, 1, sizeof head, r->file);
    if (size < sizeof head || png_sig_cmp(head, 0, sizeof head) != 0) {
        r->status = ISO_UNREADABLE;
        snprintf(r->message, VOLUME_MESSAGE, "is no PNG picture");
        return;
    }
    r->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r, refuse, ignore);
    r->info = r->png ? png_create_info_struct(r->png) : NULL;
    if (!r->info) {
        r->status = ISO_NO_MEMORY;
        snprintf(r->message, VOLUME_MESSAGE, "out of memory");
        return;
    }
    png_set_sig_bytes(r->png, sizeof head);
    if (setjmp(png_jmpbuf(r->png)) == 0)
        decode(r);
}

iso_status volume_picture_read(volume_picture *picture, const char *path, char *message) {
    reading r = {.picture = picture, .message = message};
    picture->value = NULL;
    r.file = fopen(path, "rb");
    if (!r.file) {
        snprintf(message, VOLUME_MESSAGE, "can't be read: %s", strerror(errno));
        return ISO_UNREADABLE;
    }
    read_file(&r);
    if (r.png)
        png_destroy_read_struct(&r.png, &r.info, NULL);
    fclose(r.file);
    if (r.status != ISO_OK && picture->value) {
        picture->release(picture->value);
        picture->value = NULL;
    }
    return r.status;
}
