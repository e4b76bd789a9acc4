// For short loops over plain numbers that are worth compiling for newer processors too: the best version is chosen when
// the program is loaded.
#pragma once

// Sanitizers cannot run where that choice is made.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PLICA_FOR_NEWER_PROCESSORS_TOO __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define PLICA_FOR_NEWER_PROCESSORS_TOO
#endif
