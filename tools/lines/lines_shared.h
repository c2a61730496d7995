/* What a shared library shows to the programs that load it: nothing but the functions marked with this. */
#ifndef LINES_SHARED_H
#define LINES_SHARED_H

#ifdef _WIN32
#define LINES_SHARED __declspec(dllexport)
#else
#define LINES_SHARED __attribute__((visibility("default")))
#endif

#endif
