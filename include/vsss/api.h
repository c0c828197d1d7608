// Stable. Marks what libvsss exports; everything else in it is hidden (the library is built with -fvisibility=hidden).
#ifndef VSSS_API_H
#define VSSS_API_H

#ifndef VSSS_API
#if defined(__GNUC__)
#define VSSS_API __attribute__((visibility("default")))
#else
#define VSSS_API
#endif
#endif

#endif
