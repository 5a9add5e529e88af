/* What the shared library exports; everything else in it is hidden. C and C++. */
#ifndef FASTCCD_EXPORT_H
#define FASTCCD_EXPORT_H

#if defined(__GNUC__)
#define FASTCCD_API __attribute__((visibility("default")))
#else
#define FASTCCD_API
#endif

#endif
