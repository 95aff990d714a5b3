// The form of a structure of one's own: typed with units, as `retune design` reads them.

const PLACEHOLDERS = { force: "280 N", imbalance: "0.02 kg·m", base: "1 mm", base_acceleration: "0.1 g" };

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
        by.addEventListener("change", () => (size.placeholder = PLACEHOLDERS[by.value]));
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
        const by = Object.keys(PLACEHOLDERS).find((name) => name in structure) ?? "force";
        this.form.elements.by.value = by;
        for (const input of this.form.querySelectorAll("input")) input.value = structure[input.name === "size" ? by : input.name] ?? "";
    }

    // Tells what is wrong, and marks its field; null takes that away.
    refuse(words, field = null) {
        this.problem.hidden = !words;
        this.problem.textContent = words ?? "";
        if (words) this.details.open = true;
        for (const input of this.form.querySelectorAll("input")) {
            const own = input.name === "size" ? field in PLACEHOLDERS : input.name === field?.split(".")[0];
            input.setAttribute("aria-invalid", String(own));
        }
    }
}
