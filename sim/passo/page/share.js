// SPDX-License-Identifier: MIT
// A link that carries what was typed: JSON, deflated, in base64 for addresses, as the fragment, which no server sees.
"use strict";

async function toFragment(state) {
    const bytes = await through(new Blob([JSON.stringify(state)]), new CompressionStream("deflate-raw"));
    return `#${toBase64(bytes).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

// Null: there is none, or it was cut.
async function fromFragment(fragment) {
    if (fragment.length < 2) return null;
    try {
        const bytes = fromBase64(fragment.slice(1).replaceAll("-", "+").replaceAll("_", "/"));
        return JSON.parse(new TextDecoder().decode(await through(new Blob([bytes]), new DecompressionStream("deflate-raw"))));
    } catch {
        return null;
    }
}
