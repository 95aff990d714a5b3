// The form of a structure of one's own: typed with units, as `retune design` reads them.

// The fields as a file of `retune design` has them: limits, "x1max = 2 mm, stroke = 15 mm", each by its name.
export function sent({ limits, ...structure }) {
    if (!limits) return structure;
    const pairs = limits.split(",").map((limit) => limit.split("="));
    return { ...structure, limits: Object.fromEntries(pairs.map(([name, ...value]) => [name.trim(), value.join("=").trim()])) };
}

export class Own {
    // `begin` is called with the fields that are filled in.
    constructor(details, problem, begin) {
        Object.assign(this, { details, problem });
        this.form = details.querySelector("form");
        const { by, size } = this.form.elements;
        by.addEventListener("change", () => (size.placeholder = by.selectedOptions[0].dataset.example));
        this.form.addEventListener("submit", (event) => {
            event.preventDefault();
            this.refuse(null);
            const structure = {};
            for (const { name, value } of this.form.elements) {
                if (value.trim() && !["by", ""].includes(name)) structure[name === "size" ? by.value : name] = value.trim();
            }
            begin(structure);
        });
    }

    // Fills the form with a structure.
    show(structure) {
        const by = this.forcings().find((name) => name in structure) ?? "force";
        this.form.elements.by.value = by;
        for (const input of this.form.querySelectorAll("input")) input.value = structure[input.name === "size" ? by : input.name] ?? "";
    }

    // What may move it, by the names of the fields.
    forcings() {
        return Array.from(this.form.elements.by.options, (option) => option.value);
    }

    // Tells what is wrong, and marks its field; null takes that away.
    refuse(words, field = null) {
        this.problem.hidden = !words;
        this.problem.textContent = words ?? "";
        if (words) this.details.open = true;
        for (const input of this.form.querySelectorAll("input")) {
            const own = input.name === "size" ? this.forcings().includes(field) : input.name === field?.split(".")[0];
            input.setAttribute("aria-invalid", String(own));
        }
    }
}
