/* SPDX-License-Identifier: MIT
 * What the component uses of RTAPI to be loaded.
 */
#ifndef RTAPI_APP_H
#define RTAPI_APP_H

#define MODULE_LICENSE(text)
#define MODULE_DESCRIPTION(text)
#define RTAPI_MP_INT(name, text)
#define RTAPI_MP_STRING(name, text)

int rtapi_app_main(void);
void rtapi_app_exit(void);

#endif
