// Starts the page: the server is asked before there is anything to show what it says, so that it works meanwhile.

import "./base.css";
import "./page.css";
import "./controls.css";
import { identify } from "./client";
import { Link } from "./link";
import { ownName } from "./panel/author";

const link = new Link(await identify(), ownName);
link.start();
const { App } = await import("./app");
Object.assign(window, { ringlet: new App(document.getElementById("app")!, link) });
