// SQLite's file interface (sqlite3_vfs, version 1; sqlite3_io_methods, version 2 with the WAL index in memory) over a FaultDisk. It decides
// nothing.
#include <sqlite3.h>

#include <cstring>

#include "tests/simulation/fault_disk.hpp"

namespace fracfarm::simulation {
namespace {

FaultDisk* current = nullptr;

struct Handle {
  sqlite3_file base;
  FaultDisk* disk;
  FaultDisk::File* file;
};

Handle& of(sqlite3_file* file) { return *reinterpret_cast<Handle*>(file); }

int ok(sqlite3_file*) { return SQLITE_OK; }
int ok_lock(sqlite3_file*, int) { return SQLITE_OK; }
int not_reserved(sqlite3_file*, int* result) { return *result = 0, SQLITE_OK; }
int not_known(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }
int sector_size(sqlite3_file*) { return 512; }
int powersafe(sqlite3_file*) { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; }  // what SQLite assumes of real disks

int read(sqlite3_file* f, void* to, int n, sqlite3_int64 at) { return of(f).disk->read(*of(f).file, to, n, at); }
int write(sqlite3_file* f, const void* from, int n, sqlite3_int64 at) { return of(f).disk->write(*of(f).file, from, n, at); }
int truncate(sqlite3_file* f, sqlite3_int64 n) { return of(f).disk->truncate(*of(f).file, n); }
int sync(sqlite3_file* f, int) { return of(f).disk->sync(*of(f).file); }
int size(sqlite3_file* f, sqlite3_int64* n) {
  *n = static_cast<sqlite3_int64>(of(f).file->now.size());
  return of(f).disk->dead() ? SQLITE_IOERR_FSTAT : SQLITE_OK;
}
int map_shared(sqlite3_file* f, int region, int bytes, int, void volatile** to) {
  *to = of(f).disk->shared_memory(*of(f).file, region, bytes);
  return SQLITE_OK;
}
int lock_shared(sqlite3_file*, int, int, int) { return SQLITE_OK; }
void barrier(sqlite3_file*) {}
int unmap_shared(sqlite3_file*, int) { return SQLITE_OK; }

const sqlite3_io_methods methods{2,           ok,      read,         write,     truncate,    sync,      size,
                                 ok_lock,     ok_lock, not_reserved, not_known, sector_size, powersafe, map_shared,
                                 lock_shared, barrier, unmap_shared, nullptr,   nullptr};

int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out) {
  Handle& handle = of(file);
  handle = {{nullptr}, current, nullptr};
  int code = SQLITE_OK;
  handle.file = current->open(name ? name : "temporary", (flags & SQLITE_OPEN_CREATE) != 0, code);
  if (handle.file) handle.base.pMethods = &methods;
  if (out) *out = flags;
  return code;
}

int remove(sqlite3_vfs*, const char* name, int) { return current->remove(name); }
int access(sqlite3_vfs*, const char* name, int, int* result) { return *result = current->exists(name), SQLITE_OK; }
int full_path(sqlite3_vfs*, const char* name, int most, char* to) {
  std::strncpy(to, name, static_cast<std::size_t>(most));
  return SQLITE_OK;
}
int randomness(sqlite3_vfs*, int n, char* to) { return current->random_bytes(to, n); }
int no_sleep(sqlite3_vfs*, int microseconds) { return microseconds; }
int a_day(sqlite3_vfs*, double* julian) { return *julian = 2.46e6, SQLITE_OK; }
int no_error(sqlite3_vfs*, int, char*) { return 0; }

sqlite3_vfs make_vfs() {
  sqlite3_vfs vfs{};
  vfs.iVersion = 1;
  vfs.szOsFile = sizeof(Handle);
  vfs.mxPathname = 256;
  vfs.zName = "fault";
  vfs.xOpen = open;
  vfs.xDelete = remove;
  vfs.xAccess = access;
  vfs.xFullPathname = full_path;
  vfs.xRandomness = randomness;
  vfs.xSleep = no_sleep;
  vfs.xCurrentTime = a_day;
  vfs.xGetLastError = no_error;
  return vfs;
}

}  // namespace

void FaultDisk::use(FaultDisk& disk) {
  static sqlite3_vfs vfs = make_vfs();
  current = &disk;
  sqlite3_vfs_register(&vfs, 1);
  sqlite3_test_control(SQLITE_TESTCTRL_PRNG_RESET);
}

}  // namespace fracfarm::simulation
