/* Version of these headers. C and C++; fastccd_version() in fastccd.h tells that of the library that runs. */
#ifndef FASTCCD_VERSION_H
#define FASTCCD_VERSION_H

#define FASTCCD_VERSION_MAJOR 0
#define FASTCCD_VERSION_MINOR 1
#define FASTCCD_VERSION_PATCH 0
#define FASTCCD_VERSION "0.1.0"

#endif
