// Pictures into a video file, through the program ffmpeg.
#ifndef VSSS_CLI_VIDEO_H
#define VSSS_CLI_VIDEO_H

#include <stdint.h>

#include "vsss/status.h"

typedef struct vs_video vs_video;

// Starts ffmpeg writing path (its ending chooses the container; H.264). Sizes are even. VS_USAGE: another
// ending than .mp4, .mkv, .mov or .avi; VS_FAIL: no ffmpeg (says what to install), or path cannot be written.
vs_status vs_video_open(const char *path, int width_px, int height_px, int fps, vs_video **out, vs_error *err);
// rgb: uint8_t[height_px][width_px][3], top row first.
vs_status vs_video_frame(vs_video *video, const uint8_t *rgb, vs_error *err);
// Ends the file and waits for ffmpeg; frees video (NULL is allowed). VS_FAIL: the file is not whole, with ffmpeg's reason.
vs_status vs_video_close(vs_video *video, vs_error *err);

#endif
