// The socket to the server. An answer is the length of its head, its head as JSON, and columns of numbers (see PROTOCOL.md).

export function decode(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    let at = 4 + length;
    const columns = {};
    for (const [name, count] of head.columns) {
        columns[name] = new Float64Array(buffer, at, count);
        at += 8 * count;
    }
    head.columns = columns;
    return head;
}

export class Link {
    constructor(answered, changed) {
        this.answered = answered;
        this.changed = changed;
        this.wait = 250;
        this.open();
    }

    open() {
        const address = new URL("socket", location.href);
        address.protocol = "ws:";
        address.hash = "";
        this.socket = new WebSocket(address);
        this.socket.binaryType = "arraybuffer";
        this.socket.onmessage = ({ data }) => {
            this.wait = 250;
            this.answered(decode(data));
        };
        this.socket.onopen = () => this.changed(true);
        this.socket.onclose = () => {
            this.changed(false);
            setTimeout(() => this.open(), this.wait);
            this.wait = Math.min(2 * this.wait, 8000);
        };
    }

    send(message) {
        if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
    }
}
