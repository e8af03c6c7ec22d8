// Starts the page.

import "./base.css";
import "./page.css";
import "./controls.css";
import { App } from "./app";

const app = new App(document.getElementById("app")!);
Object.assign(window, { ringlet: app });
