// Makes Embree believe that the processor has no more than the instruction sets named by $EMBREE_ISA, in any program that
// it is preloaded into. CONTRIBUTING.md says what for.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

void* rtcNewDevice(const char* config) {
  void* (*next)(const char*) = (void* (*)(const char*))dlsym(RTLD_NEXT, "rtcNewDevice");
  const char* isa = getenv("EMBREE_ISA");
  char own[256];
  snprintf(own, sizeof own, "isa=%s,%s", isa ? isa : "avx2", config ? config : "");
  return next(own);
}
