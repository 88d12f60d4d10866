// SPDX-License-Identifier: MIT
// Bytes: compressed, and as base64.
"use strict";

// What a compressor makes of a Blob.
async function through(blob, stream) {
    return new Uint8Array(await new Response(blob.stream().pipeThrough(stream)).arrayBuffer());
}

function toBase64(bytes) {
    let text = "";
    for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
    return btoa(text);
}

const fromBase64 = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
