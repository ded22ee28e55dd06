/* netcdf_extent.h: how long a classic netCDF file must be. */
#ifndef TC_READERS_NETCDF_EXTENT_H
#define TC_READERS_NETCDF_EXTENT_H

#include "core/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fails (TC_E_FILE) when the file at path is shorter than its own header says: the netCDF library would give zeros for
 * what is missing. TC_OK for a complete file and for one that is not classic netCDF. Reads the header only. */
tc_status tc_netcdf_check_extent(const char *path, tc_error *err);

#ifdef __cplusplus
}
#endif
#endif
