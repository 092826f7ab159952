/* A picture of a part and its channels within the edges of the mould. */
#ifndef ISO_CLI_CHANNEL_PICTURE_H
#define ISO_CLI_CHANNEL_PICTURE_H

#include <isoslice/channel.h>

/* SVG, seen from the front, the right and above. */
iso_status iso_channel_picture(const char *path, const iso_channels *channels) ISO_MUST_CHECK;

#endif
