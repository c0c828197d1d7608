// The built-in kinds of source.
#ifndef VSSS_VISION_CAMERA_SOURCES_H
#define VSSS_VISION_CAMERA_SOURCES_H

#include "vsss/camera.h"

extern const vs_camera_api vs_camera_v4l2;   // camera_v4l2.c: a device
extern const vs_camera_api vs_camera_file;   // camera_recording.c: a picture or a video
extern const vs_camera_api vs_camera_folder; // camera_recording.c: pictures in the order of their names

#endif
