// Files to save and lines to copy. The server writes them down and keeps nothing; the browser saves.

export function download(file, text) {
    const kind = file.endsWith(".svg") ? "image/svg+xml" : file.endsWith(".csv") ? "text/csv" : file.endsWith(".html") ? "text/html" : "application/json";
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: kind }));
    link.download = file;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

// Copies a text, and shows it, so that it can be copied by hand where the browser does not allow it.
export async function copyText(dialog, text) {
    let done = "Copied:";
    try {
        await navigator.clipboard.writeText(text);
    } catch {
        done = "To copy:";
    }
    dialog.querySelector("p").textContent = done;
    const area = dialog.querySelector("textarea");
    area.value = text;
    if (!dialog.open) dialog.showModal();
    area.select();
}
