/* SPDX-License-Identifier: GPL-3.0-or-later */
/* graph/os.h and targets/host.h for Windows. The program's manifest makes UTF-8 the code page of
 * all names (Windows 10, version 1903, and later), so the functions that take bytes do. */
#include "graph/os.h"
#include "graph/status.h"
#include "targets/host.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

/* Files, and what is read and written by pipes, are bytes: a line ends with one. */
__attribute__((constructor)) static void begin(void)
{
  _fmode = _O_BINARY;
  for (int file = 0; file < 3; file++)
    _setmode(file, _O_BINARY);
  SetConsoleOutputCP(CP_UTF8);
}

/* ---- paths ---- */

bool thr_os_is_separator(char c)
{
  return c == '/' || c == '\\';
}

const char *thr_os_name(const char *path)
{
  const char *name = path;
  for (const char *c = path; *c; c++)
    if (thr_os_is_separator(*c) || (*c == ':' && c == path + 1)) name = c + 1;
  return name;
}

/* Of a file or folder; INVALID_FILE_ATTRIBUTES if there is none. */
static DWORD attributes_of(const char *path)
{
  return GetFileAttributesA(path);
}

bool thr_os_is_folder(const char *path)
{
  const DWORD is = attributes_of(path);
  return is != INVALID_FILE_ATTRIBUTES && (is & FILE_ATTRIBUTE_DIRECTORY);
}

bool thr_os_is_file(const char *path)
{
  const DWORD is = attributes_of(path);
  return is != INVALID_FILE_ATTRIBUTES &&
         !(is & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_DEVICE));
}

bool thr_os_is_no_file(const char *path)
{
  const DWORD is = attributes_of(path);
  return is != INVALID_FILE_ATTRIBUTES &&
         (is & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_DEVICE | FILE_ATTRIBUTE_REPARSE_POINT));
}

/* What the system says of a failure, as errno. */
static void set_errno(DWORD error)
{
  switch (error) {
  case ERROR_FILE_NOT_FOUND:
  case ERROR_PATH_NOT_FOUND:
  case ERROR_BAD_PATHNAME:
  case ERROR_INVALID_DRIVE:
  case ERROR_INVALID_NAME: errno = ENOENT; break;
  case ERROR_ALREADY_EXISTS:
  case ERROR_FILE_EXISTS: errno = EEXIST; break;
  case ERROR_DIRECTORY: errno = ENOTDIR; break;
  case ERROR_DISK_FULL:
  case ERROR_HANDLE_DISK_FULL: errno = ENOSPC; break;
  case ERROR_NOT_ENOUGH_MEMORY:
  case ERROR_OUTOFMEMORY: errno = ENOMEM; break;
  case ERROR_ACCESS_DENIED:
  case ERROR_SHARING_VIOLATION:
  case ERROR_WRITE_PROTECT: errno = EACCES; break;
  default: errno = EIO;
  }
}

bool thr_os_make_folder(const char *path)
{
  if (CreateDirectoryA(path, NULL)) return true;
  set_errno(GetLastError());
  return false;
}

bool thr_os_remove_folder(const char *path)
{
  return RemoveDirectoryA(path);
}

/* What the system calls a file that is there: false if none is, or it is no file. */
static bool identity_of(const char *path, BY_HANDLE_FILE_INFORMATION *is)
{
  HANDLE file = CreateFileA(path, 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                            OPEN_EXISTING, 0, NULL);
  if (file == INVALID_HANDLE_VALUE) return false;
  const bool found = GetFileType(file) == FILE_TYPE_DISK && GetFileInformationByHandle(file, is);
  CloseHandle(file);
  return found;
}

bool thr_os_is_same_file(const char *a, const char *b)
{
  BY_HANDLE_FILE_INFORMATION x, y;
  char whole_a[MAX_PATH], whole_b[MAX_PATH];
  const bool has_a = identity_of(a, &x), has_b = identity_of(b, &y);
  if (has_a && has_b)
    return x.dwVolumeSerialNumber == y.dwVolumeSerialNumber &&
           x.nFileIndexHigh == y.nFileIndexHigh && x.nFileIndexLow == y.nFileIndexLow;
  const DWORD n = GetFullPathNameA(a, MAX_PATH, whole_a, NULL),
              m = GetFullPathNameA(b, MAX_PATH, whole_b, NULL);
  return !has_a && !has_b && n > 0 && n < MAX_PATH && m > 0 && m < MAX_PATH &&
         _stricmp(whole_a, whole_b) == 0;
}

void thr_os_cache_folder(char *path, size_t size)
{
  const char *local = getenv("LOCALAPPDATA");
  const int n = local && *local ? snprintf(path, size, "%s\\thread\\cache", local) : 0;
  if (n <= 0 || (size_t)n >= size) path[0] = '\0';
}

/* ---- writing ---- */

static bool write_all(HANDLE file, const char *data, size_t n)
{
  const size_t most = (size_t)1 << 30;
  DWORD written = 0;
  for (; n > 0; data += written, n -= written)
    if (!WriteFile(file, data, (DWORD)(n < most ? n : most), &written, NULL) || written == 0)
      return false;
  return true;
}

/* Opens, writes, waits for the disk and closes. */
static bool write_to(const char *path, DWORD how, bool on_disk, const char *data, size_t n)
{
  HANDLE file =
      CreateFileA(path, GENERIC_WRITE, FILE_SHARE_READ, NULL, how, FILE_ATTRIBUTE_NORMAL, NULL);
  DWORD why = GetLastError();
  if (file == INVALID_HANDLE_VALUE) {
    set_errno(why);
    return false;
  }
  bool done = write_all(file, data, n) && (!on_disk || FlushFileBuffers(file));
  why = GetLastError();
  CloseHandle(file);
  if (!done) set_errno(why);
  return done;
}

/* A file that is read only is not replaced, as elsewhere. The temporary file's name is this
 * process's own. */
static bool replace_file(const char *path, const char *data, size_t n)
{
  enum { NAME = 32 };
  const size_t folder = (size_t)(thr_os_name(path) - path);
  char *temporary = thr_calloc(folder + NAME, 1);
  if (!temporary) {
    errno = ENOMEM;
    return false;
  }
  memcpy(temporary, path, folder);
  snprintf(temporary + folder, NAME, ".thread-%d", _getpid());
  bool done = write_to(temporary, CREATE_ALWAYS, true, data, n);
  if (done && !MoveFileExA(temporary, path, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)) {
    set_errno(GetLastError());
    done = false;
  }
  const int why = errno;
  if (!done) DeleteFileA(temporary);
  free(temporary);
  errno = why;
  return done;
}

/* Is it a device, as NUL or CON, or a pipe? */
static bool is_device(const char *path)
{
  HANDLE file = CreateFileA(path, GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, NULL,
                            OPEN_EXISTING, 0, NULL);
  if (file == INVALID_HANDLE_VALUE) return false;
  const DWORD type = GetFileType(file);
  CloseHandle(file);
  return type != FILE_TYPE_DISK;
}

bool thr_os_write(const char *path, const char *data, size_t n)
{
  const DWORD is = attributes_of(path);
  if (is != INVALID_FILE_ATTRIBUTES && (is & FILE_ATTRIBUTE_READONLY)) {
    errno = EACCES;
    return false;
  }
  const bool link =
      is != INVALID_FILE_ATTRIBUTES && (is & FILE_ATTRIBUTE_REPARSE_POINT); /* stays one */
  if (link || is_device(path))
    return write_to(path, link ? TRUNCATE_EXISTING : OPEN_EXISTING, link, data, n);
  return replace_file(path, data, n);
}

bool thr_os_can_write(const char *path)
{
  enum { NAME = 32 };
  const DWORD is = attributes_of(path);
  const size_t folder = (size_t)(thr_os_name(path) - path);
  if (is != INVALID_FILE_ATTRIBUTES) {
    if (is & FILE_ATTRIBUTE_READONLY) errno = EACCES;
    return !(is & FILE_ATTRIBUTE_READONLY);
  }
  char *temporary = thr_calloc(folder + NAME, 1);
  if (!temporary) {
    errno = ENOMEM;
    return false;
  }
  memcpy(temporary, path, folder);
  snprintf(temporary + folder, NAME, ".thread-%d", _getpid());
  const bool can = write_to(temporary, CREATE_ALWAYS, false, "", 0);
  const int why = errno;
  DeleteFileA(temporary);
  free(temporary);
  errno = why;
  return can;
}

int thr_os_read_small(const char *path, char *data, int size)
{
  if (!thr_os_is_file(path)) return -1;
  FILE *f = fopen(path, "rb");
  if (!f) return -1;
  const size_t n = fread(data, 1, (size_t)size, f);
  const bool whole = !ferror(f) && n < (size_t)size;
  fclose(f);
  return whole ? (int)n : -1;
}

/* ---- processes ---- */

static void (*stop)(int signal);

/* Ctrl-C comes in a thread of the system's, Ctrl-Break too; the window's end gives the program some
 * seconds. */
static BOOL WINAPI on_console(DWORD event)
{
  (void)event;
  stop(SIGINT);
  return TRUE;
}

void thr_os_heed_stop(void (*on_stop)(int signal))
{
  const bool first = !stop;
  stop = on_stop;
  if (first) SetConsoleCtrlHandler(on_console, TRUE);
}

void thr_os_tick(int seconds, void (*on_tick)(int signal))
{
  (void)seconds;
  (void)on_tick;
}

int thr_os_processors(void)
{
  SYSTEM_INFO info;
  GetSystemInfo(&info);
  return info.dwNumberOfProcessors > 1 ? (int)info.dwNumberOfProcessors : 1;
}

int thr_os_columns(int file)
{
  CONSOLE_SCREEN_BUFFER_INFO info;
  return GetConsoleScreenBufferInfo((HANDLE)_get_osfhandle(file), &info)
             ? info.srWindow.Right - info.srWindow.Left + 1
             : 0;
}

static double seconds_of(FILETIME time) /* units of 100 ns */
{
  return 1e-7 * (4294967296.0 * (double)time.dwHighDateTime + (double)time.dwLowDateTime);
}

double thr_os_processor_seconds(void)
{
  FILETIME begun, ended, kernel, user;
  if (!GetProcessTimes(GetCurrentProcess(), &begun, &ended, &kernel, &user)) return 0;
  return seconds_of(kernel) + seconds_of(user);
}

/* ---- memory ---- */

/* Large pages take a right that users do not have. */
void *thr_os_on_large_pages(void *block, size_t bytes)
{
  (void)bytes;
  return block;
}

/* The process is in a job whose memory is bounded: malloc gives none beyond it. */
void host_bound_memory(double bytes)
{
  static HANDLE job;
  if (!job && bytes > 0) {
    job = CreateJobObjectA(NULL, NULL);
    if (job && !AssignProcessToJobObject(job, GetCurrentProcess())) {
      CloseHandle(
          job); /* another one, which does not allow it, has the process: it has its own bounds */
      job = NULL;
    }
  }
  if (!job) return;
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION bound = {.ProcessMemoryLimit = (SIZE_T)bytes};
  bound.BasicLimitInformation.LimitFlags = bytes > 0 ? JOB_OBJECT_LIMIT_PROCESS_MEMORY : 0;
  SetInformationJobObject(job, JobObjectExtendedLimitInformation, &bound, sizeof bound);
}

/* ---- the best plan so far ---- */

/* Ctrl-C ends a search with what it has found: nobody else wants it. */
void host_plan(const char *json, size_t n)
{
  (void)json;
  (void)n;
}
