// Starts the page.

import "./base.css";
import "./page.css";
import "./controls.css";
import { App } from "./app";
import { identify } from "./client";

const app = new App(document.getElementById("app")!, await identify());
Object.assign(window, { ringlet: app });
