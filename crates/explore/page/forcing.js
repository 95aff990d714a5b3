// What moves the structure: the study's own forcing, a pulse typed with its units, or a record from a file, which the browser reads and sends.

// The greatest text of a message; more is cut off with the connection.
const MOST = 4 << 20;
const SECONDS = { "": 1, s: 1, ms: 1e-3, min: 60 };
const PLACEHOLDERS = { force: ["10 kN", "N"], "base acceleration": ["5 g", "m/s²"] };

// A number with what stands behind it: "10 kN" is [10, "kN"]; none of what is no number.
function typed(text) {
    const [, number, unit] = text.trim().replace(",", ".").match(/^([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(.*)$/i) ?? [];
    return Number.isFinite(Number(number)) && number !== undefined ? [Number(number), unit] : null;
}

export class Forcing {
    // `begin` is called with what the server is to be sent: `forcing`, null for the study's own, and the `text` of a record.
    constructor(details, begin) {
        this.details = details;
        this.begin = begin;
        this.form = details.querySelector("form");
        const { kind, of } = this.form.elements;
        for (const select of [kind, of]) select.addEventListener("change", () => this.suit());
        this.form.addEventListener("submit", (event) => {
            event.preventDefault();
            this.refuse(null);
            this.read().then(begin, ({ field, words }) => this.refuse(words, field));
        });
        this.suit();
    }

    // Shows the fields of what is chosen.
    suit() {
        const { kind, of, peak, unit } = this.form.elements;
        const chosen = kind.value === "record" ? "record" : kind.value && "pulse";
        for (const label of this.form.querySelectorAll("[data-for]")) label.hidden = label.dataset.for !== chosen;
        of.parentElement.hidden = !chosen;
        [peak.placeholder, unit.placeholder] = PLACEHOLDERS[of.value];
    }

    async read() {
        const fields = this.form.elements;
        const [kind, of] = [fields.kind.value, fields.of.value];
        if (!kind) return { forcing: null };
        if (kind === "record") return this.record(of);
        const peak = typed(fields.peak.value);
        if (!peak) throw { field: "peak", words: `peak: "${fields.peak.value}" is not a number with its unit, as ${fields.peak.placeholder}` };
        const duration = typed(fields.duration.value);
        const size = SECONDS[duration?.[1]];
        if (!duration || !size) throw { field: "duration", words: `duration: "${fields.duration.value}" is not a number in s or ms` };
        return { forcing: { pulse: kind, of, peak: peak[0], ...(peak[1] && { unit: peak[1] }), duration: duration[0] * size } };
    }

    async record(of) {
        const fields = this.form.elements;
        const file = fields.file.files[0];
        if (!file) throw { field: "file", words: "file: choose one" };
        const forcing = { record: file.name, of };
        const column = fields.column.value.trim();
        if (column) forcing.column = /^\d+$/.test(column) ? Number(column) : column;
        if (fields.unit.value.trim()) forcing.unit = fields.unit.value.trim();
        if (fields.scale.value.trim()) {
            const scale = typed(fields.scale.value);
            if (!scale || scale[1]) throw { field: "scale", words: `scale: "${fields.scale.value}" is not a number` };
            forcing.scale = scale[0];
        }
        const text = await file.text();
        if (JSON.stringify({ force: { forcing, text } }).length > MOST)
            throw { field: "file", words: `file: ${file.name} is longer than the 4 MiB that a page sends: name it in a study, and open that with \`retune explore\`` };
        return { forcing, text };
    }

    // Fills the form with a forcing; a record's file cannot be chosen for a person.
    show(forcing) {
        const fields = this.form.elements;
        fields.kind.value = forcing ? (forcing.pulse ?? "record") : "";
        if (forcing) fields.of.value = forcing.of;
        if (forcing?.pulse) [fields.peak.value, fields.duration.value] = [`${forcing.peak} ${forcing.unit ?? ""}`.trim(), `${forcing.duration} s`];
        this.suit();
    }

    // Tells what is wrong, and marks its field; null takes that away.
    refuse(words, field = null) {
        const problem = this.details.querySelector(".wrong");
        problem.hidden = !words;
        problem.textContent = words ?? "";
        if (words) this.details.open = true;
        const place = field === "record" ? "file" : field;
        for (const input of this.form.querySelectorAll("input")) input.setAttribute("aria-invalid", String(input.name === place));
    }
}
