/* SPDX-License-Identifier: MIT
 * Generated from rtl/ and VERSION by spec/generate_package.py.
 */
#ifndef PASSO_RELEASE_H
#define PASSO_RELEASE_H

#define PASSO_RELEASE "0.3.0"

#endif
