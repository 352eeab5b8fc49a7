/* A library with the functions of OpenImageDenoise that whit calls. In place of the picture without noise it gives what the
 * environment's STAND_IN asks for: "color", "albedo" or "normal", as it came; with "error" it fails. VERSION_2 is defined
 * for the names that version 2 has. With STAND_IN_TAKES_ALL in the environment it takes all memory that it is allowed. */
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { kImages = 4 };
static const char* const kNames[kImages] = {"color", "albedo", "normal", "output"};

struct image {
  float* at;
  size_t width, height;
};
static struct {
  struct image images[kImages];
  bool hdr, committed;
  int megabytes;
} filter;
static const char* problem;

static const char* wanted(void) { return getenv("STAND_IN") ? getenv("STAND_IN") : "color"; }

void* oidnNewDevice(int type) { return type == 1 ? &filter : NULL; }
void oidnCommitDevice(void* device) { (void)device; }
void oidnReleaseDevice(void* device) { (void)device; }
int oidnGetDeviceError(void* device, const char** message) {
  (void)device;
  *message = problem;
  return problem ? 1 : 0;
}
void* oidnNewFilter(void* device, const char* type) { return device && !strcmp(type, "RT") ? &filter : NULL; }
void oidnReleaseFilter(void* which) { (void)which; }
void oidnSetSharedFilterImage(void* which, const char* name, void* at, int format, size_t width, size_t height, size_t offset,
                              size_t pixel_stride, size_t row_stride) {
  (void)which;
  for (int i = 0; i < kImages; ++i) {
    if (strcmp(name, kNames[i])) continue;
    if (format == 3 && offset == 0 && pixel_stride == 0 && row_stride == 0)
      filter.images[i] = (struct image){at, width, height};
  }
}
void oidnCommitFilter(void* which) {
  (void)which;
  filter.committed = true;
}
void oidnExecuteFilter(void* which) {
  (void)which;
  const struct image* out = &filter.images[kImages - 1];
  for (int i = 0; i < kImages; ++i) {
    const struct image* in = &filter.images[i];
    if (!in->at || in->width != out->width || in->height != out->height) problem = "an image is missing";
    else if (!strcmp(wanted(), kNames[i])) memcpy(out->at, in->at, 3 * sizeof(float) * in->width * in->height);
  }
  if (!filter.hdr || !filter.committed) problem = "the filter is not set up";
  if (!strcmp(wanted(), "error")) problem = "no memory for the network";
  if (getenv("STAND_IN_TAKES_ALL")) {
    const size_t bytes = (size_t)filter.megabytes << 20;
    char* scratch = malloc(bytes);
    if (scratch) memset(scratch, 1, bytes);
    else problem = "no memory for the network";
    free(scratch);
  }
}

static void set_bool(const char* name, bool value) {
  if (!strcmp(name, "hdr")) filter.hdr = value;
}
static int get_int(const char* name) {
#ifdef VERSION_2
  return strcmp(name, "version") ? 0 : 20301;
#else
  return strcmp(name, "version") ? 0 : 10403;
#endif
}
#ifdef VERSION_2
void oidnSetFilterBool(void* which, const char* name, bool value) {
#else
void oidnSetFilter1b(void* which, const char* name, bool value) {
#endif
  (void)which;
  set_bool(name, value);
}
#ifdef VERSION_2
void oidnSetFilterInt(void* which, const char* name, int value) {
#else
void oidnSetFilter1i(void* which, const char* name, int value) {
#endif
  (void)which;
  if (!strcmp(name, "maxMemoryMB")) filter.megabytes = value;
}
#ifdef VERSION_2
int oidnGetDeviceInt(void* device, const char* name) {
#else
int oidnGetDevice1i(void* device, const char* name) {
#endif
  (void)device;
  return get_int(name);
}
#ifdef VERSION_2
void oidnSetDeviceInt(void* device, const char* name, int value) {
#else
void oidnSetDevice1i(void* device, const char* name, int value) {
#endif
  (void)device, (void)name, (void)value;
}
