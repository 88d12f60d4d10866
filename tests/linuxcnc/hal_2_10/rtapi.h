/* SPDX-License-Identifier: MIT
 * What the component uses of RTAPI.
 */
#ifndef RTAPI_H
#define RTAPI_H

enum { RTAPI_MSG_ERR = 1 };

void rtapi_print_msg(int, const char *, ...) __attribute__((format(printf, 2, 3)));

#endif
